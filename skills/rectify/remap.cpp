#include "skills/rectify/pixel_map.hpp"
#include "skills/vision/pixel_numbers.hpp"

#include <cstring>
#include <type_traits>
#include <vector>

namespace roscell::rectify {

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
