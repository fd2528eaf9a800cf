#include "roscell/ros2/image_view.hpp"

#include "roscell/ros2/detail/cdr_reader.hpp"
#include "roscell/ros2/detail/cdr_writer.hpp"

#include <algorithm>
#include <array>

namespace roscell::ros2 {

namespace {

struct known_encoding {
  std::string_view name;
  std::uint32_t bytes;
};

constexpr std::array<known_encoding, 22> encodings{{
    {"mono8", 1},        {"mono16", 2},       {"rgb8", 3},
    {"bgr8", 3},         {"rgb16", 6},        {"bgr16", 6},
    {"rgba8", 4},        {"bgra8", 4},        {"rgba16", 8},
    {"bgra16", 8},       {"bayer_rggb8", 1},  {"bayer_bggr8", 1},
    {"bayer_gbrg8", 1},  {"bayer_grbg8", 1},  {"bayer_rggb16", 2},
    {"bayer_bggr16", 2}, {"bayer_gbrg16", 2}, {"bayer_grbg16", 2},
    {"yuv422", 2},       {"yuv422_yuy2", 2},  {"uyvy", 2},
    {"yuyv", 2},
}};

/// OpenCV's names: bits, kind, and perhaps "C" and the number of channels, as
/// in "8UC3", "32FC1" and "16U".
std::optional<std::uint32_t> bytes_of_matrix(std::string_view name) {
  constexpr std::array<known_encoding, 7> depths{{{"8U", 1},
                                                  {"8S", 1},
                                                  {"16U", 2},
                                                  {"16S", 2},
                                                  {"32S", 4},
                                                  {"32F", 4},
                                                  {"64F", 8}}};
  for (const auto& depth : depths) {
    if (name.substr(0, depth.name.size()) != depth.name)
      continue;
    auto channels = name.substr(depth.name.size());
    if (channels.empty())
      return depth.bytes;
    if (channels.size() == 2 && channels[0] == 'C' && channels[1] >= '1'
        && channels[1] <= '9')
      return depth.bytes * static_cast<std::uint32_t>(channels[1] - '0');
  }
  return std::nullopt;
}

void check_sizes(const image_view& x) {
  using std::to_string;
  if (std::uint64_t{x.step} * x.height != x.size)
    throw cdr_error("data", to_string(x.size) + " bytes are not "
                                + to_string(x.height) + " rows of "
                                + to_string(x.step) + " bytes");
  auto pixel = bytes_per_pixel(x.encoding);
  if (pixel && std::uint64_t{x.width} * *pixel > x.step)
    throw cdr_error("step", to_string(x.step) + " bytes are too few for "
                                + to_string(x.width) + " pixels of "
                                + x.encoding);
}

} // namespace

image_view view_image(std::string_view payload) {
  cdr_reader in{payload};
  image_view result;
  in.read_field("header", result.header);
  in.read_field("height", result.height);
  in.read_field("width", result.width);
  in.read_field("encoding", result.encoding);
  in.read_field("is_bigendian", result.is_bigendian);
  in.read_field("step", result.step);
  auto data = in.read_bytes("data");
  result.data = reinterpret_cast<const std::uint8_t*>(data.data());
  result.size = data.size();
  in.finish();
  check_sizes(result);
  return result;
}

std::string serialize(const image_view& image) {
  check_sizes(image);
  cdr_writer out;
  out.write(image.header);
  out.write(image.height);
  out.write(image.width);
  out.write(image.encoding);
  out.write(image.is_bigendian);
  out.write(image.step);
  out.write_count(image.size);
  auto before = out.bytes();
  std::string result;
  result.reserve(before.size() + image.size);
  result.append(before);
  result.append(reinterpret_cast<const char*>(image.data), image.size);
  return result;
}

std::optional<std::uint32_t> bytes_per_pixel(std::string_view encoding) {
  const auto* found =
      std::find_if(encodings.begin(), encodings.end(),
                   [=](const auto& x) { return x.name == encoding; });
  return found != encodings.end() ? found->bytes : bytes_of_matrix(encoding);
}

} // namespace roscell::ros2
