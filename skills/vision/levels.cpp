#include "skills/vision/levels.hpp"

#include "skills/vision/pixel_numbers.hpp"

#include <cmath>

namespace roscell::vision {

using ros2::pixel_form;

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

/// (1 2 1) down, then across.
void deep_rows::smooth(std::uint32_t y) {
  const std::size_t width = source_.width;
  numbers_.resize(3 * width);
  auto* above = numbers_.data();
  auto* here = above + width;
  auto* below = here + width;
  read(mirrored(std::int64_t{y} - 1, source_.height), above);
  read(y, here);
  read(mirrored(std::int64_t{y} + 1, source_.height), below);
  for (std::size_t x = 0; x < width; ++x)
    here[x] = above[x] + 2 * here[x] + below[x];
  const auto at = [&](std::int64_t x) {
    return here[mirrored(x, source_.width)];
  };
  const auto edge = [&](std::int64_t x) {
    row_[static_cast<std::size_t>(x)] =
        (at(x - 1) + 2 * at(x) + at(x + 1)) / 16;
  };
  for (std::size_t x = 1; x + 1 < width; ++x)
    row_[x] = (here[x - 1] + 2 * here[x] + here[x + 1]) / 16;
  edge(0);
  edge(static_cast<std::int64_t>(width) - 1);
}

levels find_levels(const ros2::image_view& source,
                   const ros2::image_encoding& encoding) {
  constexpr auto most_samples_a_side = 100U;
  const auto across = std::max(source.width / most_samples_a_side, 1U);
  const auto down = std::max(source.height / most_samples_a_side, 1U);
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
