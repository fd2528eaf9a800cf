#pragma once

#include "roscell/ros2/image_view.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace roscell::pose {

/// 8-bit brightness, row by row; the pixels belong to somebody else.
struct gray_view {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0; ///< Bytes of a row.
  const std::uint8_t* data = nullptr;
};

/// The brightness of an image. An 8-bit gray image (mono8, 8UC1) is used where
/// it lies; of mono16 the upper byte, of colours (rgb8, bgr8, rgba8, bgra8 and
/// 8UC3, 8UC4 in OpenCV's order) the luma of ITU-R BT.601 is written to
/// `buffer`. The result lives as long as `source` and `buffer`. Throws
/// std::invalid_argument when the encoding is another one.
gray_view to_gray(const ros2::image_view& source,
                  std::vector<std::uint8_t>& buffer);

/// The image with three bytes per pixel, blue first, to be drawn on.
std::vector<std::uint8_t> to_bgr(const ros2::image_view& source);

} // namespace roscell::pose
