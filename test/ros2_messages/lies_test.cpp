#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/geometry_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"

#include "bytes.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using roscell::test::bytes_of;

namespace {

ros2::apriltag_msgs::april_tag_detection_array two_tags() {
  ros2::apriltag_msgs::april_tag_detection_array x;
  x.header = {{1, 2}, "cam"};
  x.detections.resize(2);
  x.detections[0].family = "tag36h11";
  x.detections[1].family = "tag16h5";
  return x;
}

ros2::sensor_msgs::camera_info some_info() {
  ros2::sensor_msgs::camera_info x;
  x.distortion_model = "plumb_bob";
  x.d = {1, 2, 3};
  return x;
}

ros2::tf2_msgs::tf_message some_transforms() {
  return {{{{{1, 2}, "cam"}, "a", {}}, {{{1, 2}, "cam"}, "b", {}}}};
}

/// The field named by the error of reading `bytes`, or "none".
template <class T>
std::string wrong_field(std::string_view bytes) {
  try {
    ros2::deserialize<T>(bytes);
    return "none";
  } catch (const ros2::cdr_error& e) {
    return e.field();
  }
}

/// Cut anywhere, all but the padding of its end, it is refused by name.
template <class T>
void check_cuts(const T& message) {
  auto whole = ros2::serialize(message);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK(wrong_field<T>({whole.data(), size}) != "none");
  }
  for (std::size_t padding = 0; padding < 4; ++padding)
    CHECK(ros2::deserialize<T>(whole + std::string(padding, '\0')) == message);
  CHECK(wrong_field<T>(whole + std::string(4, '\0')).empty());
}

} // namespace

TEST_CASE("a message that is cut off anywhere is refused") {
  check_cuts(ros2::std_msgs::header{{1, 2}, "cam"});
  check_cuts(ros2::std_msgs::string{"hi"});
  check_cuts(
      ros2::sensor_msgs::image{{{1, 2}, "cam"}, 1, 2, "mono8", 0, 2, {1, 2}});
  check_cuts(some_info());
  check_cuts(ros2::geometry_msgs::pose_stamped{});
  check_cuts(some_transforms());
  check_cuts(two_tags());
}

TEST_CASE("an error names the field down to the item") {
  auto whole = ros2::serialize(two_tags());
  auto second = whole.find("tag16h5");
  auto broken = whole;
  broken[second - 1] = '\x7f'; // The high byte of its length.
  CHECK(wrong_field<ros2::apriltag_msgs::april_tag_detection_array>(broken)
        == "detections[1].family");
  CHECK_THROWS_WITH(
      ros2::deserialize<ros2::apriltag_msgs::april_tag_detection_array>(broken),
      Catch::StartsWith("field 'detections[1].family': its length 21307064")
          && Catch::EndsWith("bytes that are left"));
}

TEST_CASE("a count takes no memory before it is checked") {
  // Over four billion transforms of more than 100 bytes each, in 4 bytes.
  CHECK(wrong_field<ros2::tf2_msgs::tf_message>(bytes_of("00010000 ffffffff"))
        == "transforms");
  CHECK(wrong_field<ros2::std_msgs::string>(
            bytes_of("00010000 ffffffff 00000000"))
        == "data");
}

TEST_CASE("a text must end with a zero") {
  CHECK(wrong_field<ros2::std_msgs::string>(bytes_of("00010000 02000000 6869"))
        == "data");
  CHECK(ros2::deserialize<ros2::std_msgs::string>(bytes_of("00010000 00000000"))
            .data.empty());
}

TEST_CASE("a truth value is 0 or 1") {
  auto bytes = ros2::serialize(some_info());
  bytes.back() = 2;
  CHECK(wrong_field<ros2::sensor_msgs::camera_info>(bytes) == "roi.do_rectify");
}

TEST_CASE("other encapsulations are refused") {
  for (const char* start :
       {"", "00020000", "00030000", "00070000", "01010000", "ff010000"})
    CHECK(wrong_field<ros2::std_msgs::string>(
              bytes_of(start + std::string{"0100000000"}))
          == "encapsulation");
}
