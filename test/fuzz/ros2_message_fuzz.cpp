#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/geometry_msgs.hpp"
#include "roscell/ros2/rmw_dds_common.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

using namespace roscell;

/// Whatever can be read must be written and read again as the same bytes.
/// Messages are not compared: a number may be no number.
template <class T>
void check(std::string_view bytes) {
  try {
    auto written = ros2::serialize(ros2::deserialize<T>(bytes));
    if (ros2::serialize(ros2::deserialize<T>(written)) != written)
      std::abort();
  } catch (const ros2::cdr_error&) {
    // Refused by name, as it should.
  }
}

} // namespace

/// The first byte chooses the message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  if (size == 0)
    return 0;
  std::string_view bytes{reinterpret_cast<const char*>(data) + 1, size - 1};
  switch (data[0] % 8) {
  case 0:
    check<ros2::std_msgs::header>(bytes);
    break;
  case 1:
    check<ros2::std_msgs::string>(bytes);
    break;
  case 2:
    check<ros2::sensor_msgs::image>(bytes);
    break;
  case 3:
    check<ros2::sensor_msgs::camera_info>(bytes);
    break;
  case 4:
    check<ros2::geometry_msgs::pose_stamped>(bytes);
    break;
  case 5:
    check<ros2::tf2_msgs::tf_message>(bytes);
    break;
  case 6:
    check<ros2::apriltag_msgs::april_tag_detection_array>(bytes);
    break;
  default:
    check<ros2::rmw_dds_common::participant_entities_info>(bytes);
  }
  return 0;
}
