#include "skills/ros2/messages/cdr.hpp"

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
    check<ros2::header>(bytes);
    break;
  case 1:
    check<ros2::string>(bytes);
    break;
  case 2:
    check<ros2::image>(bytes);
    break;
  case 3:
    check<ros2::camera_info>(bytes);
    break;
  case 4:
    check<ros2::pose_stamped>(bytes);
    break;
  case 5:
    check<ros2::tf_message>(bytes);
    break;
  case 6:
    check<ros2::april_tag_detection_array>(bytes);
    break;
  default:
    check<ros2::participant_entities_info<24>>(bytes);
  }
  return 0;
}
