#include "roscell/ros2/image_view.hpp"

#include "roscell/ros2/detail/cdr_reader.hpp"
#include "roscell/ros2/detail/cdr_writer.hpp"
#include "roscell/ros2/image_encoding.hpp"

namespace roscell::ros2 {

namespace {

bool is_planar(const image_view& x) {
  const auto encoding = find_encoding(x.encoding);
  return encoding && encoding->form == pixel_form::planar_yuv;
}

/// Where it is known how many bytes the rows have beside those of brightness.
std::uint64_t expected_bytes(const image_view& x) {
  const auto rows = std::uint64_t{x.step} * x.height;
  const auto encoding = find_encoding(x.encoding);
  // What is more than there is anyway must not overflow.
  return encoding && rows <= x.size ? encoding->bytes_of(x.step, x.height)
                                    : rows;
}

/// OpenCV, and with it cv_bridge, counts the rows of colours among the image's.
void count_rows_of_pixels(image_view& x) {
  const auto encoding = find_encoding(x.encoding);
  if (!is_planar(x) || x.height % 3 != 0
      || std::uint64_t{x.step} * x.height != x.size)
    return;
  x.height /= 3;
  if (encoding->chroma != chroma_form::uv_full)
    x.height *= 2;
}

void check_sizes(const image_view& x) {
  using std::to_string;
  if (expected_bytes(x) != x.size)
    throw cdr_error("data", to_string(x.size) + " bytes are not "
                                + to_string(x.height) + " rows of "
                                + to_string(x.step) + " bytes"
                                + (is_planar(x) ? " in " + x.encoding : ""));
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
  count_rows_of_pixels(result);
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
  const auto found = find_encoding(encoding);
  return found ? std::optional{found->bytes_per_pixel()} : std::nullopt;
}

} // namespace roscell::ros2
