#include "skills/vision/levels.hpp"

#include "skills/vision/raw_pixels.hpp"

#include <cmath>

namespace roscell::vision {

using ros2::pixel_form;

namespace {

void add_number_rows(const float* __restrict above,
                     const float* __restrict here,
                     const float* __restrict below, std::size_t width,
                     float* __restrict sums) {
  for (std::size_t x = 0; x < width; ++x)
    sums[x] = above[x] + 2 * here[x] + below[x];
}

void add_number_columns(const float* __restrict sums, std::size_t width,
                        float* __restrict to) {
  for (std::size_t x = 0; x < width; ++x)
    to[x] = (sums[x] + 2 * sums[x + 1] + sums[x + 2]) * (1.0F / 16);
}

} // namespace

deep_rows::deep_rows(const ros2::image_view& source,
                     const ros2::image_encoding& encoding)
    : source_(source), encoding_(encoding), swapped_(is_swapped(source)),
      row_(source.width) {
  // nop
}

const float* deep_rows::row(std::uint32_t y) {
  switch (encoding_.form) {
  case pixel_form::colours:
    read_luma(y);
    break;
  case pixel_form::mosaic:
    smooth(y);
    break;
  default:
    read(y, row_.data());
  }
  return row_.data();
}

void deep_rows::read(std::uint32_t y, float* to) const {
  with_number_type(encoding_, [&](auto number) {
    read_numbers<decltype(number)>(
        row_of(source_, y), std::size_t{source_.width} * encoding_.channels,
        swapped_, to);
  });
}

void deep_rows::read_luma(std::uint32_t y) {
  numbers_.resize(std::size_t{source_.width} * encoding_.channels);
  read(y, numbers_.data());
  const auto* pixel = numbers_.data();
  for (auto& luma : row_) {
    luma = 0.114F * pixel[encoding_.blue] + 0.587F * pixel[1]
           + 0.299F * pixel[encoding_.red];
    pixel += encoding_.channels;
  }
}

/// A row that is needed for three of the result is read once.
const float* deep_rows::kept(std::uint32_t y) {
  const auto slot = y % 3;
  auto& row = kept_[slot];
  if (kept_y_[slot] != y) {
    row.resize(source_.width);
    read(y, row.data());
    kept_y_[slot] = y;
  }
  return row.data();
}

/// (1 2 1) down, then across, of sums that have one more at each end.
void deep_rows::smooth(std::uint32_t y) {
  const std::size_t width = source_.width;
  numbers_.resize(width + 2);
  const auto* above = kept(mirrored(std::int64_t{y} - 1, source_.height));
  const auto* below = kept(mirrored(std::int64_t{y} + 1, source_.height));
  add_number_rows(above, kept(y), below, width, numbers_.data() + 1);
  // Mirrored at the ends.
  numbers_.front() = numbers_[std::min<std::size_t>(2, width)];
  numbers_.back() = numbers_[std::max<std::size_t>(width, 2) - 1];
  add_number_columns(numbers_.data(), width, row_.data());
}

void levels::apply(const float* __restrict numbers, std::size_t count,
                   std::uint8_t* __restrict to) const {
  const auto known = *this;
  for (std::size_t i = 0; i < count; ++i)
    to[i] = known.of(numbers[i]);
}

levels find_levels(const ros2::image_view& source,
                   const ros2::image_encoding& encoding) {
  // A row costs more than a number of it.
  constexpr auto most_in_a_row = 128U;
  constexpr auto most_rows = 32U;
  const auto across = std::max(source.width / most_in_a_row, 1U);
  const auto down = std::max(source.height / most_rows, 1U);
  std::vector<float> samples;
  if (source.width == 0)
    return {};
  deep_rows rows{source, encoding};
  for (std::uint32_t y = down / 2; y < source.height; y += down) {
    const auto* row = rows.row(y);
    for (std::uint32_t x = across / 2; x < source.width; x += across)
      if (std::isfinite(row[x]))
        samples.push_back(row[x]);
  }
  if (samples.empty())
    return {};
  const auto rank = [&](std::size_t number) {
    const auto at = samples.begin() + static_cast<std::ptrdiff_t>(number);
    std::nth_element(samples.begin(), at, samples.end());
    return *at;
  };
  const auto spared = samples.size() / 1000;
  const auto low = rank(spared);
  const auto high = rank(samples.size() - 1 - spared);
  const auto least_range =
      encoding.numbers == ros2::number_form::real ? 1e-6F : 255.0F;
  return {low, 255 / std::max(high - low, least_range)};
}

} // namespace roscell::vision
