#include "skills/rectify/pixel_map.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace roscell::rectify {

namespace {

/// The numbers of a pixel are of one kind, and each is for itself.
struct layout {
  std::string_view encoding;
  std::uint8_t channels;
  std::uint8_t bytes; ///< Of a channel.
};

constexpr std::array<layout, 10> layouts{{{"mono8", 1, 1},
                                          {"8UC1", 1, 1},
                                          {"bgr8", 3, 1},
                                          {"rgb8", 3, 1},
                                          {"8UC3", 3, 1},
                                          {"bgra8", 4, 1},
                                          {"rgba8", 4, 1},
                                          {"8UC4", 4, 1},
                                          {"mono16", 1, 2},
                                          {"16UC1", 1, 2}}};

bool is_little_endian_machine() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

const layout& layout_of(const ros2::image_view& raw) {
  for (const auto& known : layouts)
    if (raw.encoding == known.encoding
        && (known.bytes == 1
            || (raw.is_bigendian == 0) == is_little_endian_machine()))
      return known;
  throw std::invalid_argument(
      "images in encoding '" + raw.encoding
      + "' cannot be rectified; have the camera send mono8, mono16 in this "
        "machine's byte order, rgb8, bgr8, rgba8 or bgra8");
}

/// Reads channels of a raw image, whose rows may begin anywhere.
template <class Number, int Channels>
class sampler {
public:
  explicit sampler(const ros2::image_view& raw)
      : raw_(raw), last_x_(static_cast<int>(raw.width) - 1),
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
    for (auto c = 0; c < Channels; ++c)
      target[c] = inside ? blend(right, below, get(x, y, c), get(x + 1, y, c),
                                 get(x, y + 1, c), get(x + 1, y + 1, c))
                         : blend(right, below, find(x, y, c), find(x + 1, y, c),
                                 find(x, y + 1, c), find(x + 1, y + 1, c));
  }

private:
  float get(int x, int y, int c) const {
    Number result = 0;
    std::memcpy(&result,
                raw_.data + static_cast<std::size_t>(y) * raw_.step
                    + (static_cast<std::size_t>(x) * Channels
                       + static_cast<std::size_t>(c))
                          * sizeof(Number),
                sizeof(Number));
    return result;
  }

  /// The same where the image may have no such pixel.
  float find(int x, int y, int c) const {
    auto is_there = x >= 0 && y >= 0 && x <= last_x_ && y <= last_y_;
    return is_there ? get(x, y, c) : 0;
  }

  static Number blend(float right, float below, float a, float b, float c,
                      float d) {
    auto upper = a + right * (b - a);
    auto lower = c + right * (d - c);
    constexpr auto half_a_level = 0.5F; // The cast cuts off.
    return static_cast<Number>(upper + below * (lower - upper) + half_a_level);
  }

  const ros2::image_view& raw_;
  const int last_x_;
  const int last_y_;
};

template <class Number, int Channels>
std::vector<std::uint8_t> remap_as(const ros2::image_view& raw,
                                   const pixel_map& map) {
  sampler<Number, Channels> source{raw};
  constexpr auto pixel_bytes = sizeof(Number) * Channels;
  std::vector<std::uint8_t> result(map.places.size() * pixel_bytes);
  auto* target = result.data();
  std::array<Number, Channels> pixel{};
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
  const auto& layout = layout_of(raw);
  if (layout.bytes == 2)
    return remap_as<std::uint16_t, 1>(raw, map);
  switch (layout.channels) {
  case 1:
    return remap_as<std::uint8_t, 1>(raw, map);
  case 3:
    return remap_as<std::uint8_t, 3>(raw, map);
  default:
    return remap_as<std::uint8_t, 4>(raw, map);
  }
}

} // namespace roscell::rectify
