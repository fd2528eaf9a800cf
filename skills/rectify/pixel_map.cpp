#include "skills/rectify/pixel_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roscell::rectify {

namespace {

using matrix = std::array<double, 9>; // 3x3, row by row.

/// What a direction of the camera is multiplied with to get a rectified pixel:
/// the left part of P, and R before it.
matrix to_pixels(const ros2::sensor_msgs::camera_info& info) {
  const auto& p = info.p;
  const matrix left{p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  const auto& r = info.r;
  if (std::all_of(r.begin(), r.end(), [](double x) { return x == 0; }))
    return left;
  matrix result{};
  for (auto row = 0; row < 3; ++row)
    for (auto column = 0; column < 3; ++column)
      for (auto i = 0; i < 3; ++i)
        result[3 * row + column] += left[3 * row + i] * r[3 * i + column];
  return result;
}

/// The cofactor of row and column `i`, `j`: indices turn around.
double cofactor(const matrix& m, int i, int j) {
  auto at = [&](int row, int column) { return m[3 * (row % 3) + column % 3]; };
  return at(i + 1, j + 1) * at(i + 2, j + 2)
         - at(i + 1, j + 2) * at(i + 2, j + 1);
}

double determinant(const matrix& m) {
  return m[0] * cofactor(m, 0, 0) + m[1] * cofactor(m, 0, 1)
         + m[2] * cofactor(m, 0, 2);
}

matrix inverse(const matrix& m) {
  matrix result{};
  auto scale = 1 / determinant(m);
  for (auto row = 0; row < 3; ++row)
    for (auto column = 0; column < 3; ++column)
      result[3 * row + column] = cofactor(m, column, row) * scale;
  return result;
}

/// One pixel beyond the image is as black as any place farther away, and a
/// small number stays exact.
float near_image(double x, std::uint32_t size) {
  // No number at all, where a direction lies in the plane of the camera.
  if (!(x > -1))
    return -1;
  return static_cast<float>(std::min(x, static_cast<double>(size)));
}

} // namespace

bool can_be_inverted(const ros2::sensor_msgs::camera_info& sent) {
  auto size = std::abs(determinant(to_pixels(sent)));
  return std::isfinite(size) && size > 1e-9;
}

pixel_map make_map(const ros2::sensor_msgs::camera_info& sent,
                   const vision::lens& lens) {
  auto m = inverse(to_pixels(sent));
  pixel_map result{sent.width, sent.height, {}};
  result.places.reserve(std::size_t{sent.width} * sent.height);
  for (std::uint32_t v = 0; v < sent.height; ++v)
    for (std::uint32_t u = 0; u < sent.width; ++u) {
      auto depth = m[6] * u + m[7] * v + m[8];
      auto x = (m[0] * u + m[1] * v + m[2]) / depth;
      auto y = (m[3] * u + m[4] * v + m[5]) / depth;
      const auto seen = lens.bend({x, y});
      result.places.push_back(
          {near_image(sent.k[0] * seen.x + sent.k[2], sent.width),
           near_image(sent.k[4] * seen.y + sent.k[5], sent.height)});
    }
  return result;
}

} // namespace roscell::rectify
