#include "skills/pose_estimation/gray_image.hpp"

#include <array>
#include <optional>
#include <stdexcept>

namespace roscell::pose {

namespace {

/// Where a pixel keeps its channels.
struct layout {
  const char* encoding;
  std::uint8_t bytes;
  std::uint8_t blue;
  std::uint8_t green;
  std::uint8_t red;
};

constexpr std::array<layout, 8> layouts{{{"mono8", 1, 0, 0, 0},
                                         {"8UC1", 1, 0, 0, 0},
                                         {"bgr8", 3, 0, 1, 2},
                                         {"8UC3", 3, 0, 1, 2},
                                         {"rgb8", 3, 2, 1, 0},
                                         {"bgra8", 4, 0, 1, 2},
                                         {"8UC4", 4, 0, 1, 2},
                                         {"rgba8", 4, 2, 1, 0}}};

/// Of a pixel with 16 bits the upper byte counts.
layout mono16(bool is_bigendian) {
  auto upper = static_cast<std::uint8_t>(is_bigendian ? 0 : 1);
  return {"mono16", 2, upper, upper, upper};
}

layout layout_of(const ros2::image_view& source) {
  if (source.encoding == "mono16" || source.encoding == "16UC1")
    return mono16(source.is_bigendian != 0);
  for (const auto& known : layouts)
    if (source.encoding == known.encoding)
      return known;
  throw std::invalid_argument(
      "images in encoding '" + source.encoding
      + "' cannot be used; have the camera send mono8, mono16, rgb8, bgr8, "
        "rgba8 or bgra8");
}

/// Calls `visit(pixel)` for each pixel, row by row.
template <class Visit>
void for_each_pixel(const ros2::image_view& source, std::size_t bytes,
                    Visit visit) {
  for (std::uint32_t y = 0; y < source.height; ++y) {
    const auto* pixel = source.data + std::size_t{y} * source.step;
    for (std::uint32_t x = 0; x < source.width; ++x, pixel += bytes)
      visit(pixel);
  }
}

} // namespace

gray_view to_gray(const ros2::image_view& source,
                  std::vector<std::uint8_t>& buffer) {
  auto at = layout_of(source);
  if (at.bytes == 1)
    return {source.width, source.height, source.step, source.data};
  buffer.resize(std::size_t{source.width} * source.height);
  auto* gray = buffer.data();
  for_each_pixel(source, at.bytes, [&](const std::uint8_t* pixel) {
    // Weights 0.114, 0.587 and 0.299 in 1/256, rounded.
    auto luma =
        29 * pixel[at.blue] + 150 * pixel[at.green] + 77 * pixel[at.red] + 128;
    *gray++ = static_cast<std::uint8_t>(luma / 256);
  });
  return {source.width, source.height, source.width, buffer.data()};
}

std::vector<std::uint8_t> to_bgr(const ros2::image_view& source) {
  auto at = layout_of(source);
  std::vector<std::uint8_t> result(std::size_t{source.width} * source.height
                                   * 3);
  auto* target = result.data();
  for_each_pixel(source, at.bytes, [&](const std::uint8_t* pixel) {
    *target++ = pixel[at.blue];
    *target++ = pixel[at.green];
    *target++ = pixel[at.red];
  });
  return result;
}

} // namespace roscell::pose
