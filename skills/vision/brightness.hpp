#pragma once

#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace roscell::vision {

/// 8-bit brightness, row by row; the pixels belong to somebody else.
struct gray_view {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0; ///< Bytes of a row.
  const std::uint8_t* data = nullptr;
};

/// The brightness of an image in any encoding that has one.
///
/// - 8 bits of gray, and the planes of NV12, NV21, NV24 and I420, are used
/// where
///   they lie. Of YUV by turns (YUYV, UYVY) Y is taken as it is.
/// - Of colours it is the luma of ITU-R BT.601.
/// - Of a Bayer mosaic it is a quarter of red, half of green and a quarter of
///   blue around each pixel, by the filter (1 2 1) across and down. It is the
///   same at every pixel, so that it moves no edge.
/// - Numbers of more than 8 bits, or with a sign, are stretched: see
///   `find_levels`.
///
/// The result lives as long as `source` and `buffer`. Throws
/// engine::unusable_input when nothing says how bright the pixels are.
gray_view to_gray(const ros2::image_view& source,
                  std::vector<std::uint8_t>& buffer);

/// The encoding of an image whose pixels' brightness is known. Throws
/// engine::unusable_input, naming the encoding and the remedy.
ros2::image_encoding picture_encoding(const ros2::image_view& source);

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
