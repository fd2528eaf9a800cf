#include "cell_fixture.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/topic_qos.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using engine::start_error;

TEST_CASE("a topic has the name that ROS 2 gives it in DDS") {
  CHECK(ros2::dds_topic_name("/tf") == "rt/tf");
  CHECK(ros2::dds_topic_name("/scene_1/Image2") == "rt/scene_1/Image2");
  CHECK(ros2::dds_topic_name("/" + std::string(246, 'a')).size() == 249);
}

TEST_CASE("a topic that ROS 2 would refuse is refused") {
  for (const char* name : {"", "/", "tf", "/tf/", "//tf", "/a//b", "/1a",
                           "/a/2", "/a-b", "/a b", "/\xc3\xa4", "/~", "rt/tf"})
    CHECK_THROWS_AS(ros2::dds_topic_name(name), start_error);
  CHECK_THROWS_AS(ros2::dds_topic_name("/" + std::string(247, 'a')),
                  start_error);
  CHECK_THROWS_AS(ros2::dds_topic_name(std::string{"/a\0b", 4}), start_error);
}

TEST_CASE("a type has the name that ROS 2 gives it in DDS") {
  CHECK(ros2::dds_type_name("sensor_msgs/msg/Image")
        == "sensor_msgs::msg::dds_::Image_");
  CHECK(ros2::dds_type_name("tf2_msgs/msg/TFMessage")
        == "tf2_msgs::msg::dds_::TFMessage_");
}

TEST_CASE("what is no type of a ROS 2 message is refused") {
  for (const char* name :
       {"", "Image", "image/png", "sensor_msgs/Image", "sensor_msgs/msg/",
        "/msg/Image", "sensor_msgs/srv/Image", "sensor_msgs/msg/image",
        "Sensor/msg/Image", "sensor_msgs/msg/Image/x", "a/msg/B C"})
    CHECK_THROWS_AS(ros2::dds_type_name(name), start_error);
}

TEST_CASE("any instance has a name that a ROS 2 node can have") {
  CHECK(ros2::node_name_for("poses") == "poses");
  CHECK(ros2::node_name_for("fleet-poses.poses-1") == "fleet_poses_poses_1");
  CHECK(ros2::node_name_for("7up") == "_7up");
  CHECK(ros2::node_name_for("") == "_");
  CHECK(ros2::node_name_for(std::string(300, '1')).size() == 255);
}

using namespace roscell::test;

namespace {

ros2::participant_config
config_of(const variables& values,
          const nlohmann::json& parameters = nlohmann::json::object()) {
  return ros2::read_participant_config(lookup_in(values),
                                       parameters_of(parameters));
}

std::string servers_of(const std::string& list) {
  std::string result;
  for (const auto& x : config_of({{"ROS_DISCOVERY_SERVER", list}}).servers)
    result += std::to_string(x.id) + "=" + x.address + ":"
              + std::to_string(x.port) + " ";
  return result;
}

const engine::parameters none;

/// "reliable volatile 10", and "large" if it is.
std::string words(const ros2::topic_qos& x) {
  return std::string{x.reliable ? "reliable " : "best_effort "}
         + (x.transient_local ? "transient_local " : "volatile ")
         + std::to_string(x.depth) + (x.large ? " large" : "");
}

} // namespace

TEST_CASE("a server's id is the number of semicolons before it") {
  CHECK(servers_of("10.0.0.5:12345") == "0=10.0.0.5:12345 ");
  CHECK(servers_of("10.0.0.5") == "0=10.0.0.5:11811 ");
  CHECK(servers_of(";;;10.0.0.5:1") == "3=10.0.0.5:1 ");
  CHECK(servers_of("10.0.0.5;;10.0.0.6:7") == "0=10.0.0.5:11811 2=10.0.0.6:7 ");
  CHECK(servers_of("10.0.0.5;") == "0=10.0.0.5:11811 ");
  CHECK(servers_of("").empty());
  CHECK(config_of({}).servers.empty());
}

TEST_CASE("a list of servers that makes no sense is refused") {
  for (const char* list :
       {";", "here", "10.0.0.5:", "10.0.0.5:0", "10.0.0.5:65536", "10.0.0.5:x",
        "10.0.0.5:1:2", ":1", "10.0.0.500", "10.0.0.5; 10.0.0.6"})
    CHECK_THROWS_AS(servers_of(list), start_error);
  CHECK_THROWS_AS(servers_of(std::string(256, ';') + "10.0.0.5"), start_error);
  CHECK(servers_of(std::string(255, ';') + "10.0.0.5")
        == "255=10.0.0.5:11811 ");
}

TEST_CASE("a domain is one that DDS has ports for") {
  CHECK(config_of({}).domain_id == 0);
  CHECK(config_of({{"ROS_DOMAIN_ID", "232"}}).domain_id == 232);
  for (const char* id : {"233", "-1", "x", "1 "})
    CHECK_THROWS_AS(config_of({{"ROS_DOMAIN_ID", id}}), start_error);
}

TEST_CASE("an instance names its ROS 2 node") {
  CHECK(config_of({{"ROSCELL_INSTANCE", "t-1"}, {"ROSCELL_STEP", "poses"}})
            .node_name
        == "t_1");
  CHECK(config_of({{"ROSCELL_STEP", "poses"}}).node_name == "poses");
  CHECK(config_of({}).node_name == "skill");
}

TEST_CASE("a gid has 16 or 24 bytes") {
  CHECK(config_of({}).gid_bytes == 24);
  CHECK(config_of({}, {{"ros2_gid_bytes", 16}}).gid_bytes == 16);
  CHECK_THROWS_AS(config_of({}, {{"ros2_gid_bytes", 20}}), start_error);
}

TEST_CASE("the local address is the one that reaches the server") {
  CHECK(ros2::local_address_towards({0, "127.0.0.1", 11811}) == "127.0.0.1");
}

TEST_CASE("each type has the QoS of ROS 2") {
  auto reader = [](const char* topic, const char* type) {
    return words(ros2::reader_qos(topic, type, none));
  };
  auto writer = [](const char* topic, const char* type) {
    return words(ros2::writer_qos(topic, type, none));
  };
  const auto* image = "sensor_msgs/msg/Image";
  const auto* tf = "tf2_msgs/msg/TFMessage";
  const auto* text = "std_msgs/msg/String";
  CHECK(reader("/i", image) == "best_effort volatile 5 large");
  CHECK(writer("/i", image) == "reliable volatile 5 large");
  CHECK(reader("/tf", tf) == "reliable volatile 100");
  CHECK(writer("/tf", tf) == "reliable volatile 100");
  CHECK(reader("/tf_static", tf) == "reliable transient_local 100");
  CHECK(writer("/tf_static", tf) == "reliable transient_local 1");
  CHECK(reader("/c", text) == "reliable volatile 10");
  CHECK(writer("/c", text) == "reliable volatile 10");
}

TEST_CASE("parameters replace the QoS of every port") {
  const auto all = parameters_of({{"ros2_reliability", "best_effort"},
                                  {"ros2_durability", "transient_local"},
                                  {"ros2_depth", 3}});
  const auto* text = "std_msgs/msg/String";
  CHECK(words(ros2::reader_qos("/c", text, all))
        == "best_effort transient_local 3");
  CHECK(words(ros2::writer_qos("/c", text, all))
        == "best_effort transient_local 3");
  for (const auto& wrong : {nlohmann::json{{"ros2_reliability", "sometimes"}},
                            nlohmann::json{{"ros2_durability", 1}},
                            nlohmann::json{{"ros2_depth", 0}}})
    CHECK_THROWS_AS(ros2::reader_qos("/c", text, parameters_of(wrong)),
                    start_error);
}
