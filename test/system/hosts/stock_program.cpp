#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/serialized_type.hpp"
#include "test/vision/encodings.hpp"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <utility>

/// A program as rclcpp on rmw_fastrtps_cpp would make it: participant,
/// endpoints and QoS are set up in the same way, by the environment alone, and
/// it takes `--ros-args`. It passes messages of any type from the topic `in` on
/// to the topic `out`, best effort to reliable, until SIGINT.
/// With the parameter `encoding` it is the driver of a camera, which sends what
/// comes, images of encoding mono8, in that one.
/// Usage: stock_program TYPE [--ros-args -r in:=/a -r out:=/b --enclave E
/// -p qos_overrides./a.subscription.reliability:=reliable ...]
namespace {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

struct arguments {
  std::string type;
  std::string enclave = "/";
  std::map<std::string, std::string> names{{"in", "/in"}, {"out", "/out"}};
  std::map<std::string, std::string> parameters;
};

/// Takes what it knows of `--ros-args`, as rcl does.
arguments read_arguments(int argc, char** argv) {
  arguments result;
  result.type = argc > 1 ? argv[1] : "";
  for (int i = 2; i + 1 < argc; ++i) {
    const std::string word = argv[i];
    const std::string value = argv[i + 1];
    const auto sign = value.find(":=");
    if (word == "-r" && sign != std::string::npos)
      result.names[value.substr(0, sign)] = value.substr(sign + 2);
    else if (word == "-p" && sign != std::string::npos)
      result.parameters[value.substr(0, sign)] = value.substr(sign + 2);
    else if (word == "--enclave")
      result.enclave = value;
  }
  return result;
}

/// Whether an end is reliable: as the program has it, or as its user does by
/// the parameter that rclcpp has for it.
/// @param end "in" or "out".
bool is_reliable(const arguments& args, const std::string& end) {
  const auto is_writer = end == "out";
  const auto found = args.parameters.find(
      "qos_overrides." + args.names.at(end)
      + (is_writer ? ".publisher.reliability" : ".subscription.reliability"));
  return found == args.parameters.end() ? is_writer
                                        : found->second == "reliable";
}

template <class Qos>
Qos qos_of(bool reliable) {
  Qos result;
  result.reliability().kind = reliable ? fdds::RELIABLE_RELIABILITY_QOS
                                       : fdds::BEST_EFFORT_RELIABILITY_QOS;
  result.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
  result.history().depth = 10;
  result.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  result.data_sharing().off();
  return result;
}

class relay : public fdds::DataReaderListener {
public:
  relay(fdds::DataWriter* to, std::string encoding)
      : to_(to), encoding_(std::move(encoding)) {}

  void on_data_available(fdds::DataReader* reader) override {
    std::string message;
    fdds::SampleInfo info;
    while (reader->take_next_sample(&message, &info)
           == ReturnCode_t::RETCODE_OK) {
      if (!encoding_.empty())
        message = roscell::test::sent_anew(message, encoding_);
      to_->write(&message, eprosima::fastrtps::rtps::c_InstanceHandle_Unknown);
      std::cout << "relayed " << ++count_ << std::endl;
    }
  }

private:
  fdds::DataWriter* const to_;
  const std::string encoding_;
  int count_ = 0;
};

/// Blocks the signals for all threads, and waits for one.
int await_signal(const sigset_t& set) {
  const int fd = ::signalfd(-1, &set, SFD_CLOEXEC);
  signalfd_siginfo info{};
  if (::read(fd, &info, sizeof(info)) != sizeof(info))
    return 0;
  ::close(fd);
  return static_cast<int>(info.ssi_signo);
}

} // namespace

int main(int argc, char** argv) {
  sigset_t ends;
  ::sigemptyset(&ends);
  ::sigaddset(&ends, SIGINT);
  ::sigaddset(&ends, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &ends, nullptr);
  auto args = read_arguments(argc, argv);
  fdds::DomainParticipantQos qos;
  qos.name(args.enclave);
  const auto data = "enclave=" + args.enclave + ";";
  qos.user_data().data_vec({data.begin(), data.end()});
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  auto* factory = fdds::DomainParticipantFactory::get_instance();
  auto* participant = factory->create_participant(
      domain != nullptr ? static_cast<std::uint32_t>(std::stoul(domain)) : 0,
      qos);
  const auto type = roscell::ros2::dds_type_name(args.type);
  fdds::TypeSupport{new roscell::ros2::serialized_type(type)}.register_type(
      participant);
  const auto topic = [&](const char* name) {
    return participant->create_topic(
        roscell::ros2::dds_topic_name(args.names.at(name)), type,
        fdds::TOPIC_QOS_DEFAULT);
  };
  relay passes{participant->create_publisher(fdds::PUBLISHER_QOS_DEFAULT)
                   ->create_datawriter(
                       topic("out"),
                       qos_of<fdds::DataWriterQos>(is_reliable(args, "out"))),
               args.parameters["encoding"]};
  participant->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT)
      ->create_datareader(topic("in"),
                          qos_of<fdds::DataReaderQos>(is_reliable(args, "in")),
                          &passes);
  std::cout << "relays from " << args.names.at("in") << " to "
            << args.names.at("out") << std::endl;
  std::cout << "ended by signal " << await_signal(ends) << std::endl;
  participant->delete_contained_entities();
  factory->delete_participant(participant);
  return 0;
}
