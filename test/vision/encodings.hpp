#pragma once

#include "skills/vision/image_codec.hpp"

#include <cstdint>
#include <string>
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
};

/// A gray picture as sensor_msgs/msg/Image, serialized: 10 used bits where
/// numbers have 16, and a tint where there are colours, so that pixels of a
/// Bayer mosaic differ.
std::string sent_as(const sent_image_form& form,
                    const vision::picture& picture);

} // namespace roscell::test
