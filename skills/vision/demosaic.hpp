#pragma once

#include "skills/vision/pixel_numbers.hpp"

#include <array>
#include <vector>

namespace roscell::vision {

/// Fills in the colours of a Bayer mosaic, each as the mean of those nearest to
/// the pixel: bilinear. Writes blue, green and red of each pixel to `to`.
template <class Number>
class demosaic {
public:
  demosaic(const ros2::image_view& source, const ros2::image_encoding& encoding)
      : source_(source), encoding_(encoding) {
    for (auto& row : rows_)
      row.resize(source.width);
  }

  void write(Number* to) {
    for (std::uint32_t y = 0; y < source_.height; ++y) {
      for (auto i = 0; i < 3; ++i)
        read_numbers<Number>(
            row_of(source_, mirrored(std::int64_t{y} + i - 1, source_.height)),
            source_.width, is_swapped(source_), rows_[i].data());
      const auto red_row = y % 2 == encoding_.red_y;
      for (std::uint32_t x = 0; x < source_.width; ++x, to += 3)
        fill_in(x, red_row, x % 2 == encoding_.red_x, to);
    }
  }

private:
  void fill_in(std::uint32_t x, bool red_row, bool red_column,
               Number* to) const {
    const auto left = mirrored(std::int64_t{x} - 1, source_.width);
    const auto right = mirrored(std::int64_t{x} + 1, source_.width);
    const auto& [above, here, below] = rows_;
    const Number own = here[x];
    const auto across = mean(here[left], here[right]);
    const auto down = mean(above[x], below[x]);
    if (red_row != red_column) {
      // A green pixel has red beside it, and blue above it, or the reverse.
      to[0] = red_row ? down : across;
      to[1] = own;
      to[2] = red_row ? across : down;
      return;
    }
    const auto diagonal = static_cast<Number>(
        (above[left] + above[right] + below[left] + below[right] + 2) / 4);
    to[0] = red_row ? diagonal : own;
    to[1] = static_cast<Number>(
        (here[left] + here[right] + above[x] + below[x] + 2) / 4);
    to[2] = red_row ? own : diagonal;
  }

  static Number mean(Number a, Number b) {
    return static_cast<Number>((a + b + 1) / 2);
  }

  const ros2::image_view& source_;
  const ros2::image_encoding encoding_;
  std::array<std::vector<Number>, 3> rows_; ///< Above, here and below.
};

} // namespace roscell::vision
