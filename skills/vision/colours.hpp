#pragma once

#include "roscell/ros2/image_view.hpp"

#include <cstdint>
#include <vector>

namespace roscell::vision {

/// A picture of an image in any encoding whose pixels' brightness is known:
/// three bytes a pixel, blue first, rows without gaps. A Bayer mosaic is filled
/// in linearly, YUV is that of ITU-R BT.601 with Y from 16 to 235, and numbers
/// of more than 8 bits are stretched as `to_gray` does it. Throws
/// engine::unusable_input.
std::vector<std::uint8_t> to_bgr(const ros2::image_view& source);

/// An image whose numbers each stand for themselves, as this machine writes
/// them: the image as it came where it is one; else one in `storage`, whose
/// rows have no gaps. Bayer of 8 bits and YUV become bgr8, Bayer of 16 bits
/// bgr16. Throws engine::unusable_input when the encoding is unknown.
ros2::image_view to_plain_numbers(const ros2::image_view& source,
                                  std::vector<std::uint8_t>& storage);

} // namespace roscell::vision
