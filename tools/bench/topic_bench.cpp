#include "actors/edge/dds/discovery_server.hpp"
#include "actors/edge/dds/discovery_setup.hpp"
#include "dds/server_addresses.hpp"
#include "roscell/ros2.hpp"
#include "roscell/skill/registry.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/ros2/participant.hpp"
#include "skills/ros2/participant_qos.hpp"
#include "skills/ros2/serialized_type.hpp"
#include "skills/ros2/topic_qos.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <mutex>
#include <vector>

/// Sends images from one process to another on this host, by a skill's ends of
/// a topic and by ends set up as rclcpp on rmw_fastrtps_cpp sets up its own,
/// over UDP. Each process finds the other by a discovery server, as in a cell.
/// The pairs take turns. One JSON line a pair and figure.
namespace {

using namespace roscell;
namespace dds = ros2::dds;
using wall_clock = std::chrono::system_clock;
using eprosima::fastrtps::types::ReturnCode_t;

constexpr const char* topic = "/bench/image";
constexpr const char* type = "sensor_msgs/msg/Image";
constexpr std::size_t stamp_at = 4; ///< Behind the encapsulation.

struct settings {
  std::size_t bytes = 4 << 20;
  double rate_hz = 30;
  unsigned messages = 150;
  unsigned rounds = 3;
  bool best_effort = false;
  std::string address = "127.0.0.1";
};

engine::variable_lookup lookup_of(const std::string& server) {
  return [server](const char* name) {
    return name == std::string{"ROS_DISCOVERY_SERVER"} ? server.c_str()
                                                       : nullptr;
  };
}

ros2::participant_config config_of(const std::string& server) {
  return ros2::read_participant_config(lookup_of(server), engine::parameters{});
}

/// As rmw_fastrtps_cpp of Humble makes one (rmw_fastrtps_shared_cpp,
/// src/participant.cpp), but for shared memory.
dds::DomainParticipant* make_stock_participant(const std::string& server) {
  ::setenv("ROS_DISCOVERY_SERVER", server.c_str(), 1);
  dds::DomainParticipantQos qos;
  qos.name("/"); // The enclave.
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports = {
      std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>()};
  auto* result =
      dds::DomainParticipantFactory::get_instance()->create_participant(0, qos);
  dds::TypeSupport{new ros2::serialized_type("sensor_msgs::msg::dds_::Image_")}
      .register_type(result);
  return result;
}

/// The same of a publisher and a subscription (src/publisher.cpp, qos.cpp).
template <class Qos>
Qos stock_qos(const settings& s) {
  Qos result;
  result.reliability().kind = s.best_effort ? dds::BEST_EFFORT_RELIABILITY_QOS
                                            : dds::RELIABLE_RELIABILITY_QOS;
  result.history().depth = 10;
  result.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  result.data_sharing().off();
  return result;
}

dds::Topic* stock_topic(dds::DomainParticipant* x) {
  return x->create_topic("rt/bench/image", "sensor_msgs::msg::dds_::Image_",
                         dds::TOPIC_QOS_DEFAULT);
}

/// Counts readers.
class match_listener : public dds::DataWriterListener {
public:
  void
  on_publication_matched(dds::DataWriter*,
                         const dds::PublicationMatchedStatus& status) override {
    if (status.current_count > 0)
      matched.set();
  }

  engine::stop_event matched;
};

using send_function = std::function<void(std::string&)>;

/// As a step's output is made, with everything that the engine does about it.
send_function skill_writer(const std::string& server,
                           match_listener& listener) {
  auto parts = std::make_shared<engine::registry>();
  ros2::add_ros2_protocol(*parts, lookup_of(server));
  const auto say = [&listener](const std::string& line) {
    if (line.find("has come") != std::string::npos)
      listener.matched.set();
  };
  std::shared_ptr<engine::output_handler> output =
      parts->make_output({{"ros2", topic, type}, engine::parameters{}, say});
  output->open();
  return [parts, output](std::string& payload) {
    engine::frame image;
    image.data_type = type;
    image.name = "image";
    image.payload.swap(payload);
    output->write(image);
    image.payload.swap(payload);
  };
}

send_function stock_writer(const std::string& server, const settings& s,
                           match_listener& listener) {
  auto* participant = make_stock_participant(server);
  auto qos = stock_qos<dds::DataWriterQos>(s);
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  auto* writer =
      participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT)
          ->create_datawriter(stock_topic(participant), qos, &listener);
  return [writer](std::string& payload) {
    writer->write(&payload, eprosima::fastrtps::rtps::c_InstanceHandle_Unknown);
  };
}

double cpu_seconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& x) {
    return static_cast<double>(x.tv_sec)
           + static_cast<double>(x.tv_usec) * 1e-6;
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void write_images(bool as_skill, const std::string& server, const settings& s,
                  int report) {
  match_listener listener;
  const auto send = as_skill ? skill_writer(server, listener)
                             : stock_writer(server, s, listener);
  listener.matched.wait_until(std::chrono::steady_clock::now()
                              + std::chrono::seconds{10});
  std::string payload(s.bytes, 'x');
  std::memcpy(payload.data(), "\0\1\0\0", stamp_at);
  const auto period = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>{1 / s.rate_hz});
  engine::stop_event never;
  auto due = std::chrono::steady_clock::now() + std::chrono::milliseconds{300};
  for (unsigned i = 0; i < s.messages; ++i, due += period) {
    never.wait_until(due);
    const auto now = wall_clock::now().time_since_epoch().count();
    std::memcpy(payload.data() + stamp_at, &now, sizeof(now));
    send(payload);
  }
  never.wait_until(std::chrono::steady_clock::now() + std::chrono::seconds{1});
  const double used = cpu_seconds();
  if (::write(report, &used, sizeof(used)) < 0)
    ::_exit(1);
}

/// Keeps how long each image took.
class image_listener : public dds::DataReaderListener {
public:
  void on_data_available(dds::DataReader* reader) override {
    dds::SampleInfo info;
    while (reader->take_next_sample(&payload_, &info)
           == ReturnCode_t::RETCODE_OK) {
      wall_clock::rep sent = 0;
      std::memcpy(&sent, payload_.data() + stamp_at, sizeof(sent));
      const auto now = wall_clock::now().time_since_epoch().count();
      const std::lock_guard guard{mutex_};
      latencies_ms_.push_back(static_cast<double>(now - sent) / 1e6);
    }
  }

  std::vector<double> latencies_ms() {
    const std::lock_guard guard{mutex_};
    return latencies_ms_;
  }

private:
  std::string payload_;
  std::mutex mutex_;
  std::vector<double> latencies_ms_;
};

/// Reads until the parent closes its end of `stop`, then reports.
void read_images(bool as_skill, const std::string& server, const settings& s,
                 int stop, int report) {
  image_listener listener;
  std::unique_ptr<ros2::participant> skill;
  if (as_skill) {
    skill = std::make_unique<ros2::participant>(config_of(server));
    auto qos = ros2::reader_qos(topic, type, engine::parameters{});
    qos.reliable = !s.best_effort;
    skill->add_reader(topic, type, qos, &listener);
  } else {
    auto* stock = make_stock_participant(server);
    stock->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(stock_topic(stock),
                            stock_qos<dds::DataReaderQos>(s), &listener);
  }
  char byte = 0;
  while (::read(stop, &byte, 1) > 0) {
    // Only the end of it counts.
  }
  const auto latencies = listener.latencies_ms();
  const double used = cpu_seconds();
  std::vector<double> words{used};
  words.insert(words.end(), latencies.begin(), latencies.end());
  if (::write(report, words.data(), words.size() * sizeof(double)) < 0)
    ::_exit(1);
}

/// What one turn of a pair gave.
struct turn {
  double cpu_s = 0;
  std::vector<double> latencies_ms;
};

std::vector<double> read_all(int fd) {
  std::vector<double> result;
  double word = 0;
  while (::read(fd, &word, sizeof(word)) == sizeof(word))
    result.push_back(word);
  return result;
}

template <class Work>
pid_t run_child(Work work) {
  const auto child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  return child;
}

struct pipe_ends {
  pipe_ends() {
    int fds[2];
    if (::pipe2(fds, O_CLOEXEC) != 0)
      throw std::runtime_error{"no pipe"};
    read = fds[0];
    write = fds[1];
  }

  int read;
  int write;
};

turn take_turn(bool writer_is_skill, bool reader_is_skill,
               const std::string& server, const settings& s) {
  const pipe_ends stop;
  const pipe_ends heard;
  const pipe_ends said;
  const auto reader = run_child([&] {
    ::close(stop.write);
    read_images(reader_is_skill, server, s, stop.read, heard.write);
  });
  const auto writer = run_child([&] {
    ::close(stop.write);
    write_images(writer_is_skill, server, s, said.write);
  });
  ::close(heard.write);
  ::close(said.write);
  ::waitpid(writer, nullptr, 0);
  ::close(stop.write);
  auto words = read_all(heard.read);
  ::waitpid(reader, nullptr, 0);
  turn result;
  if (words.empty())
    return result;
  result.cpu_s = words.front();
  for (const double x : read_all(said.read))
    result.cpu_s += x;
  result.latencies_ms.assign(words.begin() + 1, words.end());
  for (const int fd : {stop.read, heard.read, said.read})
    ::close(fd);
  return result;
}

double quantile(std::vector<double> xs, double q) {
  if (xs.empty())
    return -1;
  std::sort(xs.begin(), xs.end());
  return xs[static_cast<std::size_t>(q * static_cast<double>(xs.size() - 1))];
}

void report(const std::string& pair, const settings& s, const turn& sum) {
  const auto sent = static_cast<double>(s.messages) * s.rounds;
  const auto arrived = static_cast<double>(sum.latencies_ms.size());
  const double gib = arrived * static_cast<double>(s.bytes) / (1 << 30);
  std::cout << nlohmann::json{{"figure", "image over a topic"},
                              {"pair", pair},
                              {"bytes", s.bytes},
                              {"rate_hz", s.rate_hz},
                              {"reliable", !s.best_effort},
                              {"arrived_share", arrived / sent},
                              {"median_ms", quantile(sum.latencies_ms, 0.5)},
                              {"p99_ms", quantile(sum.latencies_ms, 0.99)},
                              {"cpu_s_per_gib", gib > 0 ? sum.cpu_s / gib : -1}}
            << std::endl;
}

void run(const settings& s, const std::string& server) {
  struct pair {
    const char* name;
    bool writer_is_skill;
    bool reader_is_skill;
    turn sum;
  };
  std::vector<pair> pairs{{"skill to skill", true, true, {}},
                          {"stock to stock", false, false, {}},
                          {"skill to stock", true, false, {}},
                          {"stock to skill", false, true, {}}};
  for (unsigned round = 0; round < s.rounds; ++round)
    for (auto& x : pairs) {
      auto one = take_turn(x.writer_is_skill, x.reader_is_skill, server, s);
      x.sum.cpu_s += one.cpu_s;
      x.sum.latencies_ms.insert(x.sum.latencies_ms.end(),
                                one.latencies_ms.begin(),
                                one.latencies_ms.end());
    }
  for (const auto& x : pairs)
    report(x.name, s, x.sum);
}

} // namespace

int main(int argc, char** argv) {
  settings s;
  CLI::App app{"Times images from one process to another over a ROS 2 topic."};
  app.add_option("--bytes", s.bytes, "Of one image")->capture_default_str();
  app.add_option("--hz", s.rate_hz, "Images a second")->capture_default_str();
  app.add_option("--messages", s.messages, "Of a turn")->capture_default_str();
  app.add_option("--rounds", s.rounds, "Turns of each pair")
      ->capture_default_str();
  app.add_option("--address", s.address, "Of this host")->capture_default_str();
  app.add_flag("--best-effort", s.best_effort, "Of the readers");
  CLI11_PARSE(app, argc, argv);
  // The server has threads, and the processes are to be forked without any.
  const pipe_ends ready;
  const auto host = run_child([&] {
    prepare_dds_environment();
    cell_server_options options;
    options.address = s.address;
    options.port = 0;
    options.server_id = 1;
    auto server = cell_server::open(options);
    const auto* open = std::get_if<std::unique_ptr<cell_server>>(&server);
    const double port = open != nullptr ? (*open)->port() : 0;
    if (::write(ready.write, &port, sizeof(port)) > 0)
      ::pause();
  });
  double port = 0;
  if (::read(ready.read, &port, sizeof(port)) != sizeof(port) || port == 0) {
    std::cerr << "topic_bench: no discovery server on " << s.address << "\n";
    return 1;
  }
  run(s, ros_discovery_server(1, s.address + ":"
                                     + std::to_string(static_cast<int>(port))));
  ::kill(host, SIGTERM);
  ::waitpid(host, nullptr, 0);
  return 0;
}
