#pragma once

#include "roscell/ros2/image_view.hpp"
#include "skills/vision/lens.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell::rectify {

/// A place in the raw image, in pixels; the middle of the upper left one is
/// (0, 0).
struct place {
  float x = 0;
  float y = 0;
};

/// Where the raw image shows each pixel of the rectified one, row by row.
struct pixel_map {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<place> places;
};

/// The map for images as `sent` describes them (see describe_sent_images), by
/// its K, R and P and the lens, as OpenCV's initUndistortRectifyMap has it. An
/// R that is all zero turns nothing. K and P have positive focal lengths, and R
/// is zero or can be inverted.
pixel_map make_map(const ros2::sensor_msgs::camera_info& sent,
                   const vision::lens& lens);

/// Whether `make_map` can invert what P and R do to a direction.
bool can_be_inverted(const ros2::sensor_msgs::camera_info& sent);

/// The pixels that the map makes of a raw image of its size, whose numbers each
/// stand for themselves (see vision::to_plain_numbers): linear between four
/// pixels, black where the raw image shows nothing, rows without gaps.
std::vector<std::uint8_t> remap(const ros2::image_view& raw,
                                const pixel_map& map);

} // namespace roscell::rectify
