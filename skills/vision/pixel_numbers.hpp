#pragma once

#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

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

} // namespace roscell::vision
