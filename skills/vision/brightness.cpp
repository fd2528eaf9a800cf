#include "skills/vision/brightness.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/vision/levels.hpp"
#include "skills/vision/raw_pixels.hpp"

namespace roscell::vision {

namespace {

using ros2::image_encoding;
using ros2::image_view;
using ros2::pixel_form;

bool lies_ready(const image_encoding& x) {
  return x.form == pixel_form::planar_yuv
         || (x.form == pixel_form::gray && x.bits == 8
             && x.numbers == ros2::number_form::unsigned_whole);
}

/// Rows of the loops below do not overlap, which lets a compiler use wide
/// registers.
void pick_luma(const std::uint8_t* __restrict from, std::size_t width,
               std::uint8_t* __restrict to) {
  for (std::size_t x = 0; x < width; ++x)
    to[x] = from[2 * x];
}

void mix_luma(const std::uint8_t* pixel, const image_encoding& at,
              std::size_t width, std::uint8_t* to) {
  for (std::size_t x = 0; x < width; ++x, pixel += at.channels) {
    // Weights 0.114, 0.587 and 0.299 in 1/256, rounded.
    const auto luma =
        29 * pixel[at.blue] + 150 * pixel[1] + 77 * pixel[at.red] + 128;
    to[x] = static_cast<std::uint8_t>(luma / 256);
  }
}

/// (1 2 1) down.
void add_rows(const std::uint8_t* __restrict above,
              const std::uint8_t* __restrict here,
              const std::uint8_t* __restrict below, std::size_t width,
              std::uint16_t* __restrict sums) {
  for (std::size_t x = 0; x < width; ++x)
    sums[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
}

/// (1 2 1) across, of sums that have one more at each end.
void add_columns(const std::uint16_t* __restrict sums, std::size_t width,
                 std::uint8_t* __restrict to) {
  for (std::size_t x = 0; x < width; ++x) {
    const auto sum =
        static_cast<std::uint16_t>(sums[x] + 2 * sums[x + 1] + sums[x + 2] + 8);
    to[x] = static_cast<std::uint8_t>(sum / 16);
  }
}

void smooth_mosaic(const image_view& source, std::uint8_t* to) {
  const auto width = std::size_t{source.width};
  std::vector<std::uint16_t> sums(width + 2);
  for (std::uint32_t y = 0; y < source.height; ++y, to += width) {
    add_rows(row_of(source, mirrored(std::int64_t{y} - 1, source.height)),
             row_of(source, y),
             row_of(source, mirrored(std::int64_t{y} + 1, source.height)),
             width, sums.data() + 1);
    // Mirrored at the ends.
    sums.front() = sums[std::min<std::size_t>(2, width)];
    sums.back() = sums[std::max<std::size_t>(width, 2) - 1];
    add_columns(sums.data(), width, to);
  }
}

void stretch(const image_view& source, const image_encoding& encoding,
             std::uint8_t* to) {
  const auto known = find_levels(source, encoding);
  deep_rows rows{source, encoding};
  for (std::uint32_t y = 0; y < source.height; ++y) {
    known.apply(rows.row(y), source.width, to);
    to += source.width;
  }
}

void convert_rows(const image_view& source, const image_encoding& encoding,
                  std::uint8_t* to) {
  if (encoding.bits > 8
      || encoding.numbers != ros2::number_form::unsigned_whole)
    return stretch(source, encoding, to);
  if (encoding.form == pixel_form::mosaic)
    return smooth_mosaic(source, to);
  for (std::uint32_t y = 0; y < source.height; ++y, to += source.width)
    if (encoding.form == pixel_form::packed_yuv)
      pick_luma(row_of(source, y) + encoding.luma, source.width, to);
    else
      mix_luma(row_of(source, y), encoding, source.width, to);
}

} // namespace

image_encoding picture_encoding(const image_view& source) {
  const auto encoding = ros2::find_encoding(source.encoding);
  if (!encoding || !encoding->is_picture())
    throw engine::unusable_input(
        "images in encoding '" + source.encoding + "', of which "
        + (encoding ? "nothing says how bright a pixel is" : "nothing is known")
        + "; have the camera send gray, colours, Bayer or YUV, as "
          "skills/README.md lists them");
  return *encoding;
}

gray_view to_gray(const image_view& source, std::vector<std::uint8_t>& buffer) {
  const auto encoding = picture_encoding(source);
  if (lies_ready(encoding))
    return {source.width, source.height, source.step, source.data};
  buffer.resize(std::size_t{source.width} * source.height);
  if (!buffer.empty())
    convert_rows(source, encoding, buffer.data());
  return {source.width, source.height, source.width, buffer.data()};
}

} // namespace roscell::vision
