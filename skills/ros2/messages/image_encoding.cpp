#include "roscell/ros2/image_encoding.hpp"

#include <algorithm>
#include <array>

namespace roscell::ros2 {

namespace {

struct named_encoding {
  std::string_view name;
  image_encoding what;
};

constexpr image_encoding gray(std::uint8_t bits) {
  image_encoding result;
  result.form = pixel_form::gray;
  result.bits = bits;
  return result;
}

constexpr image_encoding colours(std::uint8_t channels, std::uint8_t bits,
                                 std::uint8_t blue) {
  image_encoding result;
  result.form = pixel_form::colours;
  result.channels = channels;
  result.bits = bits;
  result.blue = blue;
  result.red = static_cast<std::uint8_t>(2 - blue);
  return result;
}

constexpr image_encoding mosaic(std::uint8_t bits, std::uint8_t red_x,
                                std::uint8_t red_y) {
  image_encoding result;
  result.form = pixel_form::mosaic;
  result.bits = bits;
  result.red_x = red_x;
  result.red_y = red_y;
  return result;
}

constexpr image_encoding packed(std::uint8_t luma) {
  image_encoding result;
  result.form = pixel_form::packed_yuv;
  result.channels = 2;
  result.luma = luma;
  return result;
}

constexpr image_encoding planar(chroma_form chroma) {
  image_encoding result;
  result.form = pixel_form::planar_yuv;
  result.chroma = chroma;
  return result;
}

constexpr std::array<named_encoding, 26> known_names{{
    {"mono8", gray(8)},
    {"mono16", gray(16)},
    {"rgb8", colours(3, 8, 2)},
    {"bgr8", colours(3, 8, 0)},
    {"rgba8", colours(4, 8, 2)},
    {"bgra8", colours(4, 8, 0)},
    {"rgb16", colours(3, 16, 2)},
    {"bgr16", colours(3, 16, 0)},
    {"rgba16", colours(4, 16, 2)},
    {"bgra16", colours(4, 16, 0)},
    {"bayer_rggb8", mosaic(8, 0, 0)},
    {"bayer_bggr8", mosaic(8, 1, 1)},
    {"bayer_gbrg8", mosaic(8, 0, 1)},
    {"bayer_grbg8", mosaic(8, 1, 0)},
    {"bayer_rggb16", mosaic(16, 0, 0)},
    {"bayer_bggr16", mosaic(16, 1, 1)},
    {"bayer_gbrg16", mosaic(16, 0, 1)},
    {"bayer_grbg16", mosaic(16, 1, 0)},
    {"yuv422", packed(1)},
    {"uyvy", packed(1)},
    {"yuv422_yuy2", packed(0)},
    {"yuyv", packed(0)},
    {"nv12", planar(chroma_form::uv_pairs)},
    {"nv21", planar(chroma_form::vu_pairs)},
    {"nv24", planar(chroma_form::uv_full)},
    {"i420", planar(chroma_form::planes)},
}};

struct matrix_depth {
  std::string_view name;
  std::uint8_t bits;
  number_form numbers;
};

constexpr std::array<matrix_depth, 7> depths{
    {{"8U", 8, number_form::unsigned_whole},
     {"8S", 8, number_form::signed_whole},
     {"16U", 16, number_form::unsigned_whole},
     {"16S", 16, number_form::signed_whole},
     {"32S", 32, number_form::signed_whole},
     {"32F", 32, number_form::real},
     {"64F", 64, number_form::real}}};

image_encoding matrix(const matrix_depth& depth, std::uint8_t channels) {
  image_encoding result;
  if (channels == 1)
    result = gray(depth.bits);
  else if ((channels == 3 || channels == 4)
           && depth.numbers == number_form::unsigned_whole)
    result = colours(channels, depth.bits, 0);
  result.channels = channels;
  result.bits = depth.bits;
  result.numbers = depth.numbers;
  return result;
}

/// Bits, kind, and perhaps "C" and the number of channels.
std::optional<image_encoding> find_matrix(std::string_view name) {
  for (const auto& depth : depths) {
    if (name.substr(0, depth.name.size()) != depth.name)
      continue;
    const auto rest = name.substr(depth.name.size());
    if (rest.empty())
      return matrix(depth, 1);
    if (rest.size() == 2 && rest[0] == 'C' && rest[1] >= '1' && rest[1] <= '9')
      return matrix(depth, static_cast<std::uint8_t>(rest[1] - '0'));
  }
  return std::nullopt;
}

char small(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_word(std::string_view known, std::string_view given) {
  return std::equal(known.begin(), known.end(), given.begin(), given.end(),
                    [](char a, char b) { return a == small(b); });
}

} // namespace

std::uint64_t image_encoding::bytes_of(std::uint64_t step,
                                       std::uint64_t height) const {
  const auto brightness = step * height;
  if (form != pixel_form::planar_yuv)
    return brightness;
  const auto rows = (height + 1) / 2;
  switch (chroma) {
  case chroma_form::uv_full:
    return 3 * brightness;
  case chroma_form::planes:
    return brightness + 2 * ((step + 1) / 2) * rows;
  default:
    return brightness + step * rows;
  }
}

std::optional<image_encoding> find_encoding(std::string_view name) {
  for (const auto& known : known_names)
    if (same_word(known.name, name))
      return known.what;
  return find_matrix(name);
}

} // namespace roscell::ros2
