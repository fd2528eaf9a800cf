#include "skills/ros2/participant_config.hpp"

#include "roscell/skill/errors.hpp"

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
