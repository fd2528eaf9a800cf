#pragma once

#include "roscell/ros2/std_msgs.hpp"
#include "skills/vision/image_codec.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Images as cameras send them.
namespace roscell::test {

/// What skills make of an encoding.
struct encoding_use {
  const char* name;
  bool has_brightness;   ///< pose_estimation and convert can use it.
  const char* rectified; ///< What rectify makes of it.
};

/// Every encoding of sensor_msgs/image_encodings.hpp, and i420.
const std::vector<encoding_use>& all_encodings();

struct sent_image_form {
  std::string encoding;
  bool big_endian = false;
  std::uint32_t gap = 0; ///< Bytes behind each row.
  ros2::std_msgs::header header{{12, 34}, "eye"};
};

/// A gray picture as sensor_msgs/msg/Image, serialized: 10 used bits where
/// numbers have 16, and a tint where there are colours, so that pixels of a
/// Bayer mosaic differ.
std::string sent_as(const sent_image_form& form,
                    const vision::picture& picture);

/// An image of encoding mono8 in another one, with the same header. An encoding
/// that is in no table is the image's in name only.
std::string sent_anew(std::string_view mono8, const std::string& encoding);

} // namespace roscell::test
