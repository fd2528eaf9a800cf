#pragma once

#include "skills/ros2/messages/std_msgs.hpp"

#include <vector>

namespace roscell::ros2 {

/// sensor_msgs/msg/Image. Who has many of them uses `image_view`, which does
/// not copy the pixels.
struct image {
  static constexpr const char* type_name = "sensor_msgs/msg/Image";

  ros2::header header;
  std::uint32_t height = 0; ///< Rows.
  std::uint32_t width = 0;  ///< Pixels of a row.
  std::string encoding;     ///< e.g. "mono8", see `bytes_per_pixel`.
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0; ///< Bytes of a row.
  std::vector<std::uint8_t> data;

  static constexpr auto fields() {
    return std::make_tuple(
        named("header", &image::header), named("height", &image::height),
        named("width", &image::width), named("encoding", &image::encoding),
        named("is_bigendian", &image::is_bigendian),
        named("step", &image::step), named("data", &image::data));
  }
};

/// sensor_msgs/msg/RegionOfInterest: pixels.
struct region_of_interest {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;

  static constexpr auto fields() {
    return std::make_tuple(
        named("x_offset", &region_of_interest::x_offset),
        named("y_offset", &region_of_interest::y_offset),
        named("height", &region_of_interest::height),
        named("width", &region_of_interest::width),
        named("do_rectify", &region_of_interest::do_rectify));
  }
};

/// sensor_msgs/msg/CameraInfo. Matrices are stored row by row.
struct camera_info {
  static constexpr const char* type_name = "sensor_msgs/msg/CameraInfo";

  ros2::header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model; ///< e.g. "plumb_bob"
  std::vector<double> d;        ///< Distortion.
  std::array<double, 9> k{};    ///< 3x3: intrinsics of the raw image, pixels.
  std::array<double, 9> r{};    ///< 3x3: rectification.
  std::array<double, 12> p{};   ///< 3x4: projection of the rectified image.
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  region_of_interest roi;

  static constexpr auto fields() {
    return std::make_tuple(
        named("header", &camera_info::header),
        named("height", &camera_info::height),
        named("width", &camera_info::width),
        named("distortion_model", &camera_info::distortion_model),
        named("d", &camera_info::d), named("k", &camera_info::k),
        named("r", &camera_info::r), named("p", &camera_info::p),
        named("binning_x", &camera_info::binning_x),
        named("binning_y", &camera_info::binning_y),
        named("roi", &camera_info::roi));
  }
};

} // namespace roscell::ros2
