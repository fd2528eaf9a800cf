#pragma once

#include "skills/vision/pixel_numbers.hpp"

#include <array>

namespace roscell::vision {

/// The colours of an image in YUV. Where its width is odd the last pixel has
/// the colour of those before it.
class yuv_pixels {
public:
  yuv_pixels(const ros2::image_view& source,
             const ros2::image_encoding& encoding)
      : source_(source), encoding_(encoding) {
    // nop
  }

  /// Blue, green and red of ITU-R BT.601, with Y from 16 to 235.
  std::array<std::uint8_t, 3> bgr(std::uint32_t x, std::uint32_t y) const {
    const auto [u, v] = chroma(x, y);
    const auto c = 298 * std::max(luma(x, y) - 16, 0) + 128;
    return {byte((c + 516 * u) / 256), byte((c - 100 * u - 208 * v) / 256),
            byte((c + 409 * v) / 256)};
  }

private:
  static std::uint8_t byte(int x) {
    return static_cast<std::uint8_t>(std::clamp(x, 0, 255));
  }

  bool is_packed() const {
    return encoding_.form == ros2::pixel_form::packed_yuv;
  }

  int luma(std::uint32_t x, std::uint32_t y) const {
    const auto* row = row_of(source_, y);
    return is_packed() ? row[2 * std::size_t{x} + encoding_.luma] : row[x];
  }

  /// U and V, from -128 to 127.
  std::array<int, 2> chroma(std::uint32_t x, std::uint32_t y) const {
    using ros2::chroma_form;
    const std::size_t step = source_.step;
    const auto* planes = row_of(source_, source_.height);
    if (!is_packed() && encoding_.chroma == chroma_form::uv_full)
      return around_zero(planes + 2 * (step * y + x), 1);
    // One pixel alone has no pair.
    if (source_.width < 2)
      return {0, 0};
    const std::size_t pair = std::min(x, source_.width - 2) / 2;
    if (is_packed())
      return around_zero(row_of(source_, y) + 4 * pair + 1 - encoding_.luma, 2);
    if (encoding_.chroma != chroma_form::planes)
      return around_zero(planes + step * (y / 2) + 2 * pair, 1);
    const auto plane_step = (step + 1) / 2;
    const auto rows = (std::size_t{source_.height} + 1) / 2;
    return around_zero(planes + plane_step * (y / 2) + pair, plane_step * rows);
  }

  std::array<int, 2> around_zero(const std::uint8_t* first,
                                 std::size_t to_second) const {
    const auto one = first[0] - 128;
    const auto other = first[to_second] - 128;
    const auto v_first =
        !is_packed() && encoding_.chroma == ros2::chroma_form::vu_pairs;
    return v_first ? std::array{other, one} : std::array{one, other};
  }

  const ros2::image_view& source_;
  const ros2::image_encoding encoding_;
};

} // namespace roscell::vision
