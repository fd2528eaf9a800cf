#include "test/vision/encodings.hpp"

#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"

#include <algorithm>
#include <cstring>

namespace roscell::test {

namespace {

using ros2::chroma_form;
using ros2::image_encoding;
using ros2::number_form;
using ros2::pixel_form;
using bytes = std::vector<std::uint8_t>;

constexpr double tint[] = {0.7, 1.0, 0.85}; // Of blue, green and red.
constexpr std::uint8_t u_of_all = 118;
constexpr std::uint8_t v_of_all = 139;

template <class Number>
void append(bytes& to, Number x, bool big_endian) {
  std::uint8_t raw[sizeof(x)];
  std::memcpy(raw, &x, sizeof(x));
  if (big_endian)
    std::reverse(raw, raw + sizeof(x));
  to.insert(to.end(), raw, raw + sizeof(x));
}

/// A brightness from 0 to 255 as a camera of this depth has it.
void append_number(bytes& to, double brightness, const image_encoding& encoding,
                   bool big_endian) {
  const auto whole = static_cast<int>(brightness + 0.5);
  if (encoding.numbers == number_form::real)
    return encoding.bits == 32
               ? append(to, static_cast<float>(brightness / 255), big_endian)
               : append(to, brightness / 255, big_endian);
  const auto is_signed = encoding.numbers == number_form::signed_whole;
  if (encoding.bits == 8)
    return append(to,
                  static_cast<std::uint8_t>(is_signed ? whole - 128 : whole),
                  big_endian);
  if (encoding.bits == 16)
    return append(
        to, static_cast<std::uint16_t>(is_signed ? 4 * whole - 300 : 4 * whole),
        big_endian);
  append(to, std::int32_t{1000 * whole}, big_endian);
}

/// Which colour a number of a pixel is: 0 is blue, 1 green, 2 red.
unsigned colour_of(const image_encoding& encoding, unsigned channel, unsigned x,
                   unsigned y) {
  if (encoding.form == pixel_form::colours)
    return channel == encoding.blue ? 0 : channel == encoding.red ? 2 : 1;
  if (encoding.form != pixel_form::mosaic)
    return 1;
  const auto red_column = x % 2 == encoding.red_x;
  const auto red_row = y % 2 == encoding.red_y;
  return red_column != red_row ? 1 : red_row ? 2 : 0;
}

void append_pixel(bytes& to, std::uint8_t brightness, unsigned x, unsigned y,
                  const image_encoding& encoding, bool big_endian) {
  if (encoding.form == pixel_form::packed_yuv) {
    const auto colour = x % 2 == 0 ? u_of_all : v_of_all;
    to.push_back(encoding.luma == 0 ? brightness : colour);
    to.push_back(encoding.luma == 0 ? colour : brightness);
    return;
  }
  for (auto c = 0U; c < encoding.channels; ++c)
    append_number(to, brightness * tint[colour_of(encoding, c, x, y)], encoding,
                  big_endian);
}

/// The same colour everywhere.
void append_chroma(bytes& to, const ros2::image_view& image, chroma_form form) {
  const auto behind = image.size - to.size();
  if (form == chroma_form::planes) {
    to.insert(to.end(), behind / 2, u_of_all);
    to.insert(to.end(), behind / 2, v_of_all);
    return;
  }
  const auto v_first = form == chroma_form::vu_pairs;
  for (std::size_t i = 0; i < behind / 2; ++i) {
    to.push_back(v_first ? v_of_all : u_of_all);
    to.push_back(v_first ? u_of_all : v_of_all);
  }
}

} // namespace

const std::vector<encoding_use>& all_encodings() {
  static const std::vector<encoding_use> result{
      {"rgb8", true, "rgb8"},          {"rgba8", true, "rgba8"},
      {"rgb16", true, "rgb16"},        {"rgba16", true, "rgba16"},
      {"bgr8", true, "bgr8"},          {"bgra8", true, "bgra8"},
      {"bgr16", true, "bgr16"},        {"bgra16", true, "bgra16"},
      {"mono8", true, "mono8"},        {"mono16", true, "mono16"},
      {"8UC1", true, "8UC1"},          {"8UC2", false, "8UC2"},
      {"8UC3", true, "8UC3"},          {"8UC4", true, "8UC4"},
      {"8SC1", true, "8SC1"},          {"8SC2", false, "8SC2"},
      {"8SC3", false, "8SC3"},         {"8SC4", false, "8SC4"},
      {"16UC1", true, "16UC1"},        {"16UC2", false, "16UC2"},
      {"16UC3", true, "16UC3"},        {"16UC4", true, "16UC4"},
      {"16SC1", true, "16SC1"},        {"16SC2", false, "16SC2"},
      {"16SC3", false, "16SC3"},       {"16SC4", false, "16SC4"},
      {"32SC1", true, "32SC1"},        {"32SC2", false, "32SC2"},
      {"32SC3", false, "32SC3"},       {"32SC4", false, "32SC4"},
      {"32FC1", true, "32FC1"},        {"32FC2", false, "32FC2"},
      {"32FC3", false, "32FC3"},       {"32FC4", false, "32FC4"},
      {"64FC1", true, "64FC1"},        {"64FC2", false, "64FC2"},
      {"64FC3", false, "64FC3"},       {"64FC4", false, "64FC4"},
      {"bayer_rggb8", true, "bgr8"},   {"bayer_bggr8", true, "bgr8"},
      {"bayer_gbrg8", true, "bgr8"},   {"bayer_grbg8", true, "bgr8"},
      {"bayer_rggb16", true, "bgr16"}, {"bayer_bggr16", true, "bgr16"},
      {"bayer_gbrg16", true, "bgr16"}, {"bayer_grbg16", true, "bgr16"},
      {"uyvy", true, "bgr8"},          {"yuv422", true, "bgr8"},
      {"yuyv", true, "bgr8"},          {"yuv422_yuy2", true, "bgr8"},
      {"nv12", true, "bgr8"},          {"nv21", true, "bgr8"},
      {"nv24", true, "bgr8"},          {"i420", true, "bgr8"}};
  return result;
}

std::string sent_as(const sent_image_form& form,
                    const vision::picture& picture) {
  const auto encoding = ros2::find_encoding(form.encoding).value();
  ros2::image_view image;
  image.header = form.header;
  image.width = picture.width;
  image.height = picture.height;
  image.encoding = form.encoding;
  image.is_bigendian = form.big_endian ? 1 : 0;
  image.step = picture.width * encoding.bytes_per_pixel() + form.gap;
  image.size = encoding.bytes_of(image.step, image.height);
  bytes data;
  data.reserve(image.size);
  for (auto y = 0U; y < picture.height; ++y) {
    for (auto x = 0U; x < picture.width; ++x)
      append_pixel(data, picture.pixels[y * picture.step() + x], x, y, encoding,
                   form.big_endian);
    data.insert(data.end(), form.gap, 0xAA);
  }
  if (encoding.form == pixel_form::planar_yuv)
    append_chroma(data, image, encoding.chroma);
  image.data = data.data();
  return ros2::serialize(image);
}

std::string sent_anew(std::string_view mono8, const std::string& encoding) {
  auto image = ros2::view_image(mono8);
  if (!ros2::find_encoding(encoding)) {
    image.encoding = encoding;
    return ros2::serialize(image);
  }
  vision::picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.pixels.assign(image.data, image.data + image.size);
  sent_image_form form;
  form.encoding = encoding;
  form.header = image.header;
  return sent_as(form, picture);
}

} // namespace roscell::test
