#pragma once

#include "roscell/ros2/std_msgs.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace roscell::ros2 {

/// A sensor_msgs/msg/Image whose pixels belong to somebody else. Where colours
/// have rows of their own (NV12 and the like) they follow those of the pixels,
/// which `height` counts.
struct image_view {
  std_msgs::header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;             ///< Bytes of a row.
  const std::uint8_t* data = nullptr; ///< The pixels, row by row.
  std::size_t size = 0;               ///< Bytes at `data`.
};

/// The image in `payload`, which must live as long as the result. The sizes do
/// not lie: `step * height == size`, beside rows of colours, and if the
/// encoding is known a row of `width` pixels fits into `step`. A `height` that
/// counts rows of colours, as OpenCV has it, is corrected. Throws cdr_error.
image_view view_image(std::string_view payload);

/// Copies the pixels once. Throws cdr_error when the sizes lie.
std::string serialize(const image_view& image);

/// Bytes of one pixel in a row of an encoding that `find_encoding` knows; none
/// if it is unknown.
std::optional<std::uint32_t> bytes_per_pixel(std::string_view encoding);

} // namespace roscell::ros2
