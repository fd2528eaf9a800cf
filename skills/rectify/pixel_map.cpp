#include "skills/rectify/pixel_map.hpp"

#include "skills/vision/raw_pixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

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

namespace {

/// Fractions of 32 bits have too few digits for some numbers.
template <class Number>
using fraction =
    std::conditional_t<(sizeof(Number) < 4 || std::is_same_v<Number, float>),
                       float, double>;

/// Reads channels of a raw image, whose rows may begin anywhere. `Channels` is
/// their number if it is known when this is compiled, else 0.
template <class Number, int Channels>
class sampler {
public:
  sampler(const ros2::image_view& raw, int channels)
      : raw_(raw), channels_(channels),
        last_x_(static_cast<int>(raw.width) - 1),
        last_y_(static_cast<int>(raw.height) - 1) {
    // nop
  }

  void sample(const place& at, Number* target) const {
    // Rounds down, because no place is left of or above -1.
    auto x = static_cast<int>(at.x + 1) - 1;
    auto y = static_cast<int>(at.y + 1) - 1;
    auto right = at.x - static_cast<float>(x);
    auto below = at.y - static_cast<float>(y);
    auto inside = x >= 0 && y >= 0 && x < last_x_ && y < last_y_;
    for (auto c = 0; c < channels(); ++c)
      target[c] = inside ? blend(right, below, get(x, y, c), get(x + 1, y, c),
                                 get(x, y + 1, c), get(x + 1, y + 1, c))
                         : blend(right, below, find(x, y, c), find(x + 1, y, c),
                                 find(x, y + 1, c), find(x + 1, y + 1, c));
  }

  int channels() const {
    return Channels > 0 ? Channels : channels_;
  }

private:
  using part = fraction<Number>;

  part get(int x, int y, int c) const {
    Number result = 0;
    std::memcpy(&result,
                raw_.data + static_cast<std::size_t>(y) * raw_.step
                    + (static_cast<std::size_t>(x)
                           * static_cast<std::size_t>(channels())
                       + static_cast<std::size_t>(c))
                          * sizeof(Number),
                sizeof(Number));
    return static_cast<part>(result);
  }

  /// The same where the image may have no such pixel.
  part find(int x, int y, int c) const {
    auto is_there = x >= 0 && y >= 0 && x <= last_x_ && y <= last_y_;
    return is_there ? get(x, y, c) : 0;
  }

  static Number blend(float right, float below, part a, part b, part c,
                      part d) {
    const auto upper = a + right * (b - a);
    const auto lower = c + right * (d - c);
    const auto mixed = upper + below * (lower - upper);
    if constexpr (std::is_floating_point_v<Number>)
      return mixed;
    // The cast cuts off.
    const auto half_a_level = static_cast<part>(mixed < 0 ? -0.5 : 0.5);
    return static_cast<Number>(mixed + half_a_level);
  }

  const ros2::image_view& raw_;
  const int channels_;
  const int last_x_;
  const int last_y_;
};

template <class Number, int Channels = 0>
std::vector<std::uint8_t> remap_as(const ros2::image_view& raw,
                                   const pixel_map& map, int channels) {
  sampler<Number, Channels> source{raw, channels};
  std::vector<Number> pixel(static_cast<std::size_t>(source.channels()));
  const auto pixel_bytes = sizeof(Number) * pixel.size();
  std::vector<std::uint8_t> result(map.places.size() * pixel_bytes);
  auto* target = result.data();
  for (const auto& at : map.places) {
    source.sample(at, pixel.data());
    std::memcpy(target, pixel.data(), pixel_bytes);
    target += pixel_bytes;
  }
  return result;
}

} // namespace

std::vector<std::uint8_t> remap(const ros2::image_view& raw,
                                const pixel_map& map) {
  const auto encoding = ros2::find_encoding(raw.encoding).value();
  const int channels = encoding.channels;
  return vision::with_number_type(encoding, [&](auto number) {
    using number_type = decltype(number);
    if constexpr (std::is_same_v<number_type, std::uint8_t>) {
      // What cameras send most.
      if (channels == 1)
        return remap_as<number_type, 1>(raw, map, 1);
      if (channels == 3)
        return remap_as<number_type, 3>(raw, map, 3);
    }
    return remap_as<number_type>(raw, map, channels);
  });
}

} // namespace roscell::rectify
