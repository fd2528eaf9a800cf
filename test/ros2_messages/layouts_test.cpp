#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/builtin_interfaces.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/geometry_msgs.hpp"
#include "roscell/ros2/rmw_dds_common.hpp"
#include "roscell/ros2/rmw_dds_common_iron.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"

#include "bytes.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using roscell::test::bytes_of;
using roscell::test::hex_of;

// Bytes as ROS 2 nodes send them, behind "00 01 00 00" for little endian.
namespace {

const std::string le = "00010000";
/// Second 1, nanosecond 2, frame "cam".
const std::string header_cam = "01000000 02000000 04000000 63616d00";
const std::string one = "000000000000f03f";
const std::string two = "0000000000000040";
const std::string zero = "0000000000000000";

const ros2::std_msgs::header cam{{1, 2}, "cam"};

/// Written it is these bytes, and read it is the message again.
template <class T>
void check_layout(const T& message, const std::string& hex) {
  auto bytes = bytes_of(hex);
  CHECK(hex_of(ros2::serialize(message)) == hex_of(bytes));
  CHECK(ros2::deserialize<T>(bytes) == message);
}

std::string times(int count, const std::string& hex) {
  std::string result;
  for (int i = 0; i < count; ++i)
    result += hex;
  return result;
}

} // namespace

TEST_CASE("std_msgs/Header has the layout of ROS 2") {
  check_layout(cam, le + header_cam);
  check_layout(ros2::std_msgs::header{{-1, 999999999}, ""},
               le + "ffffffff ffc99a3b 01000000 00");
}

TEST_CASE("std_msgs/String has the layout of ROS 2") {
  check_layout(ros2::std_msgs::string{"hi"}, le + "03000000 686900");
}

TEST_CASE("sensor_msgs/Image has the layout of ROS 2") {
  ros2::sensor_msgs::image x{cam, 2, 1, "rgb8", 0, 4, {1, 2, 3, 0, 4, 5, 6, 0}};
  check_layout(x, le + header_cam
                      + "02000000 01000000 05000000 7267623800"
                        "00 0000 04000000 08000000 01020300 04050600");
}

TEST_CASE("sensor_msgs/CameraInfo has the layout of ROS 2") {
  ros2::sensor_msgs::camera_info x;
  x.header = cam;
  x.height = 480;
  x.width = 640;
  x.distortion_model = "plumb_bob";
  x.d = {1, 2};
  x.k.fill(1);
  x.r.fill(0);
  x.p.fill(2);
  x.binning_x = 3;
  x.binning_y = 4;
  x.roi = {5, 6, 7, 8, true};
  // The text ends at 38, its count at 44, so the doubles begin at 48.
  check_layout(x, le + header_cam
                      + "e0010000 80020000 0a000000 706c756d625f626f6200 0000"
                        "02000000 00000000"
                      + one + two + times(9, one) + times(9, zero)
                      + times(12, two)
                      + "03000000 04000000"
                        "05000000 06000000 07000000 08000000 01");
}

TEST_CASE("geometry_msgs/PoseStamped has the layout of ROS 2") {
  check_layout(
      ros2::geometry_msgs::pose_stamped{cam, {{1, 2, 0}, {0, 0, 0, 1}}},
      le + header_cam + one + two + times(4, zero) + one);
}

TEST_CASE("tf2_msgs/TFMessage has the layout of ROS 2") {
  ros2::tf2_msgs::tf_message x{
      {{cam, "tag36h11:7", {{1, 2, 0}, {0, 0, 0, 1}}}}};
  const auto hex = le + "01000000" + header_cam
                   + "0b000000 74616733366831313a3700 00 00000000" + one + two
                   + times(4, zero) + one;
  check_layout(x, hex);
  // As measured between two real ROS 2 nodes.
  CHECK(ros2::serialize(x).size() == 100);
  check_layout(ros2::tf2_msgs::tf_message{}, le + "00000000");
}

TEST_CASE("apriltag_msgs/AprilTagDetectionArray has the layout of ROS 2") {
  ros2::apriltag_msgs::april_tag_detection tag;
  tag.family = "tag36h11";
  tag.id = 7;
  tag.hamming = 1;
  tag.decision_margin = 1.0F;
  tag.centre = {1, 2};
  tag.corners.fill({2, 1});
  tag.homography.fill(1);
  ros2::apriltag_msgs::april_tag_detection_array x{cam, {tag}};
  check_layout(x, le + header_cam
                      + "01000000 09000000 746167333668313100 000000"
                        "07000000 01000000 00000000 0000803f 00000000"
                      + one + two + times(4, two + one) + times(9, one));
  // As measured with apriltag_ros.
  CHECK(ros2::serialize(x).size() == 212);
}

TEST_CASE("the graph's message has the gid width of each ROS 2") {
  ros2::rmw_dds_common_iron::participant_entities_info iron;
  iron.gid.data.fill(0xaa);
  iron.node_entities_info_seq = {{"/", "n", {}, {iron.gid}}};
  const auto after_gid = "01000000 02000000 2f00 0000 02000000 6e00 0000"
                         "00000000 01000000";
  check_layout(iron, le + times(16, "aa") + after_gid + times(16, "aa"));
  ros2::rmw_dds_common::participant_entities_info humble;
  humble.gid.data.fill(0xbb);
  humble.node_entities_info_seq = {{"/", "n", {}, {humble.gid}}};
  check_layout(humble, le + times(24, "bb") + after_gid + times(24, "bb"));
}

TEST_CASE("messages are read in the other byte order too") {
  auto bytes = bytes_of("00000000 00000001 00000002 00000004 63616d00");
  CHECK(ros2::deserialize<ros2::std_msgs::header>(bytes) == cam);
}

TEST_CASE("a stamp is a time of the system's clock") {
  using namespace std::chrono;
  for (const ros2::builtin_interfaces::time& stamp :
       {ros2::builtin_interfaces::time{1, 999999999},
        ros2::builtin_interfaces::time{-2, 5},
        ros2::builtin_interfaces::time{}})
    CHECK(ros2::to_time(ros2::to_time_point(stamp)) == stamp);
  CHECK(ros2::to_time_point({1, 500000000}).time_since_epoch() == 1500ms);
}
