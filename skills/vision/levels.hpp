#pragma once

#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::vision {

/// How numbers become 8 bits: `low` and less are 0.
struct levels {
  float low = 0;
  float per_number = 1; ///< Of 255 levels.

  std::uint8_t of(float number) const {
    const auto level = (number - low) * per_number + 0.5F;
    // What is no number is black: it is less than nothing.
    return static_cast<std::uint8_t>(std::min(std::max(0.0F, level), 255.0F));
  }

  /// The same for `count` of them, which do not overlap.
  void apply(const float* __restrict numbers, std::size_t count,
             std::uint8_t* __restrict to) const;
};

/// The brightness of rows of an image of more than 8 bits, as the numbers that
/// were sent: those of gray, the luma of colours, the smoothed ones of a
/// mosaic.
class deep_rows {
public:
  deep_rows(const ros2::image_view& source,
            const ros2::image_encoding& encoding);

  /// Row `y`, as many numbers as the image is wide, until the next call.
  const float* row(std::uint32_t y);

private:
  void read(std::uint32_t y, float* to) const;
  void read_luma(std::uint32_t y);
  void smooth(std::uint32_t y);
  const float* kept(std::uint32_t y);

  const ros2::image_view& source_;
  const ros2::image_encoding encoding_;
  const bool swapped_;
  std::vector<float> row_;
  std::vector<float> numbers_; ///< As they were sent, or sums of a mosaic.
  /// Rows of a mosaic as they were sent, each at its number modulo 3.
  std::array<std::vector<float>, 3> kept_;
  std::array<std::int64_t, 3> kept_y_{-1, -1, -1};
};

/// Levels by which an image uses most of 8 bits, whatever depth its camera
/// uses: of 1000 numbers one may be darker than black and one brighter than
/// white, so that a broken pixel counts for nothing. Judged by at most some
/// 10,000 pixels. Whole numbers are never spread, so that the noise of a dark
/// image stays dark.
levels find_levels(const ros2::image_view& source,
                   const ros2::image_encoding& encoding);

} // namespace roscell::vision
