#include "cell_fixture.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "skills/ros2/participant.hpp"
#include "skills/ros2/serialized_type.hpp"
#include "this_program.hpp"

#include <catch2/catch.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::size_t message_count = 3;

} // namespace

TEST_CASE("what the writer's process does", "[.][writer]") {
  variables environment;
  for (const char* name : {"ROS_DISCOVERY_SERVER", "ROS_DOMAIN_ID"})
    if (const auto* value = std::getenv(name))
      environment[name] = value;
  skill writing{environment};
  auto output = writing.output("/chatter", text);
  REQUIRE(writing.log.wait_for("a reader has come"));
  for (std::size_t i = 0; i < message_count; ++i)
    output->write(text_frame(std::to_string(i)));
  output->close();
}

TEST_CASE("messages go from process to process, and none is lost at the end") {
  cell home{5};
  skill reading{home.environment("reader")};
  running_input input{reading.input("/chatter", text)};
  auto writer = this_program("[writer]", home.environment("writer"));
  for (std::size_t i = 0; i < message_count; ++i)
    CHECK(text_of(input.sink().wait_for(i)) == std::to_string(i));
  auto code = writer.wait();
  CAPTURE(writer.output());
  CHECK(code == 0);
}

TEST_CASE("without a server, skills find each other by multicast") {
  // Of this run alone: others may be testing on this network.
  const auto domain = 10 + ::getpid() % 80;
  const variables alone{{"ROS_DOMAIN_ID", std::to_string(domain)}};
  skill reading{alone};
  running_input input{reading.input("/chatter", text)};
  auto writer = this_program("[writer]", alone);
  CHECK(input.sink().wait_for(message_count - 1));
  CHECK(writer.wait() == 0);
}

namespace {

/// Keeps the first text it reads.
class text_listener : public ros2::dds::DataReaderListener {
public:
  void on_data_available(ros2::dds::DataReader* reader) override {
    std::string payload;
    ros2::dds::SampleInfo info;
    if (reader->take_next_sample(&payload, &info)
        == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
      log.say()(ros2::deserialize<ros2::std_msgs::string>(payload).data);
  }

  logbook log;
};

} // namespace

TEST_CASE("what a program of ROS 2 does", "[.][stock]") {
  // As rmw_fastrtps does it: what the environment says of discovery. UDP by
  // the cell's address is what an XML profile says to programs in containers.
  ros2::dds::DomainParticipantQos settings;
  auto udp =
      std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  settings.transport().use_builtin_transports = false;
  settings.transport().user_transports = {udp};
  auto* factory = ros2::dds::DomainParticipantFactory::get_instance();
  auto* participant = factory->create_participant(0, settings);
  REQUIRE(participant != nullptr);
  const std::string type = "std_msgs::msg::dds_::String_";
  ros2::dds::TypeSupport{new ros2::serialized_type(type)}.register_type(
      participant);
  auto* topic = participant->create_topic("rt/chatter", type,
                                          ros2::dds::TOPIC_QOS_DEFAULT);
  ros2::dds::DataReaderQos qos;
  qos.reliability().kind = ros2::dds::RELIABLE_RELIABILITY_QOS;
  text_listener listener;
  participant->create_subscriber(ros2::dds::SUBSCRIBER_QOS_DEFAULT)
      ->create_datareader(topic, qos, &listener);
  CHECK(listener.log.wait_for("hello"));
  participant->delete_contained_entities();
  factory->delete_participant(participant);
}

TEST_CASE("a program of ROS 2 joins the cell by the same variables") {
  cell home{7};
  skill writing{home.environment("writer")};
  auto output = writing.output("/chatter", text);
  auto program = this_program("[stock]", home.environment("program"));
  REQUIRE(writing.log.wait_for("a reader has come"));
  output->write(text_frame("hello"));
  auto code = program.wait();
  CAPTURE(program.output());
  CHECK(code == 0);
}
