#pragma once

#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace roscell::vision {

inline bool is_little_endian_machine() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

/// Whether numbers of several bytes are not as this machine writes them.
inline bool is_swapped(const ros2::image_view& source) {
  return (source.is_bigendian == 0) != is_little_endian_machine();
}

/// Row or column `i` of `size`, mirrored at the border; a Bayer mosaic goes on
/// beyond it so. `i` is at most 1 off the image.
inline std::uint32_t mirrored(std::int64_t i, std::uint32_t size) {
  const std::int64_t last = static_cast<std::int64_t>(size) - 1;
  const auto inside = i < 0 ? -i : i > last ? 2 * last - i : i;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(inside, 0, last));
}

inline const std::uint8_t* row_of(const ros2::image_view& source,
                                  std::uint32_t y) {
  return source.data + std::size_t{y} * source.step;
}

/// Copies numbers out of a row, which may begin anywhere.
template <class Number, class Target>
void read_numbers(const std::uint8_t* from, std::size_t count, bool swapped,
                  Target* to) {
  if (!swapped) {
    for (std::size_t i = 0; i < count; ++i) {
      Number x;
      std::memcpy(&x, from + i * sizeof(Number), sizeof(Number));
      to[i] = static_cast<Target>(x);
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t bytes[sizeof(Number)] = {};
    std::reverse_copy(from + i * sizeof(Number),
                      from + (i + 1) * sizeof(Number), bytes);
    Number x;
    std::memcpy(&x, bytes, sizeof(Number));
    to[i] = static_cast<Target>(x);
  }
}

/// Calls `visit` with a number of the type that the encoding has.
template <class Visit>
auto with_number_type(const ros2::image_encoding& encoding, Visit visit) {
  using ros2::number_form;
  switch (encoding.numbers) {
  case number_form::real:
    return encoding.bits == 32 ? visit(float{}) : visit(double{});
  case number_form::signed_whole:
    return encoding.bits == 8    ? visit(std::int8_t{})
           : encoding.bits == 16 ? visit(std::int16_t{})
                                 : visit(std::int32_t{});
  default:
    return encoding.bits == 8 ? visit(std::uint8_t{}) : visit(std::uint16_t{});
  }
}

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
