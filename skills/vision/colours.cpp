#include "skills/vision/brightness.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/vision/levels.hpp"
#include "skills/vision/raw_pixels.hpp"

#include <cstring>

namespace roscell::vision {

namespace {

using ros2::image_encoding;
using ros2::image_view;
using ros2::pixel_form;
using bytes = std::vector<std::uint8_t>;

std::size_t pixels_of(const image_view& source) {
  return std::size_t{source.width} * source.height;
}

bool is_plain(const image_encoding& encoding) {
  return encoding.form == pixel_form::gray
         || encoding.form == pixel_form::colours
         || encoding.form == pixel_form::numbers;
}

bool is_deep(const image_encoding& encoding) {
  return encoding.bits > 8
         || encoding.numbers != ros2::number_form::unsigned_whole;
}

bytes bgr_of_yuv(const image_view& source, const image_encoding& encoding) {
  bytes result;
  result.reserve(3 * pixels_of(source));
  const yuv_pixels pixels{source, encoding};
  for (std::uint32_t y = 0; y < source.height; ++y)
    for (std::uint32_t x = 0; x < source.width; ++x)
      for (auto colour : pixels.bgr(x, y))
        result.push_back(colour);
  return result;
}

/// Blue, green and red of a mosaic in the machine's order.
template <class Number>
bytes bgr_of_mosaic(const image_view& source, const image_encoding& encoding) {
  std::vector<Number> numbers(3 * pixels_of(source));
  demosaic<Number>{source, encoding}.write(numbers.data());
  bytes result(numbers.size() * sizeof(Number));
  if (!result.empty())
    std::memcpy(result.data(), numbers.data(), result.size());
  return result;
}

/// The same numbers in the machine's order.
bytes turned(const image_view& source, const image_encoding& encoding) {
  const auto count = std::size_t{source.width} * encoding.channels;
  bytes result(count * encoding.bits / 8 * source.height);
  with_number_type(encoding, [&](auto number) {
    using number_type = decltype(number);
    std::vector<number_type> row(count);
    for (std::uint32_t y = 0; y < source.height && count > 0; ++y) {
      read_numbers<number_type>(row_of(source, y), count, true, row.data());
      std::memcpy(result.data() + y * count * sizeof(number_type), row.data(),
                  count * sizeof(number_type));
    }
  });
  return result;
}

void stretch_gray(const image_view& source, const image_encoding& encoding,
                  std::uint8_t* to) {
  const auto known = find_levels(source, encoding);
  deep_rows rows{source, encoding};
  for (std::uint32_t y = 0; y < source.height; ++y) {
    const auto* row = rows.row(y);
    for (std::uint32_t x = 0; x < source.width; ++x, to += 3)
      std::memset(to, known.of(row[x]), 3);
  }
}

/// A mosaic has become bgr16 before.
void stretch_colours(const image_view& plain, const levels& known,
                     std::uint8_t* to) {
  const auto at = ros2::find_encoding(plain.encoding).value();
  std::vector<float> row(std::size_t{plain.width} * at.channels);
  for (std::uint32_t y = 0; y < plain.height; ++y) {
    read_numbers<std::uint16_t>(row_of(plain, y), row.size(), false,
                                row.data());
    const auto* pixel = row.data();
    for (std::uint32_t x = 0; x < plain.width; ++x, pixel += at.channels)
      for (auto channel : {at.blue, std::uint8_t{1}, at.red})
        *to++ = known.of(pixel[channel]);
  }
}

bytes stretched(const image_view& source, const image_encoding& encoding) {
  bytes result(3 * pixels_of(source));
  if (result.empty())
    return result;
  if (encoding.form == pixel_form::gray) {
    stretch_gray(source, encoding, result.data());
    return result;
  }
  bytes storage;
  stretch_colours(to_plain_numbers(source, storage),
                  find_levels(source, encoding), result.data());
  return result;
}

bytes reordered(const image_view& source, const image_encoding& at) {
  bytes result(3 * pixels_of(source));
  auto* to = result.data();
  const auto green = std::min<std::uint8_t>(1, at.channels - 1);
  for (std::uint32_t y = 0; y < source.height; ++y) {
    const auto* pixel = row_of(source, y);
    for (std::uint32_t x = 0; x < source.width; ++x, pixel += at.channels) {
      *to++ = pixel[at.blue];
      *to++ = pixel[green];
      *to++ = pixel[at.red];
    }
  }
  return result;
}

image_view view_of(const image_view& source, const char* encoding,
                   const bytes& storage) {
  auto result = source;
  result.encoding = encoding;
  result.is_bigendian = is_little_endian_machine() ? 0 : 1;
  result.step =
      source.height == 0
          ? 0
          : static_cast<std::uint32_t>(storage.size() / source.height);
  result.data = storage.data();
  result.size = storage.size();
  return result;
}

} // namespace

bytes to_bgr(const image_view& source) {
  const auto encoding = picture_encoding(source);
  if (is_deep(encoding))
    return stretched(source, encoding);
  if (encoding.form == pixel_form::mosaic)
    return bgr_of_mosaic<std::uint8_t>(source, encoding);
  return is_plain(encoding) ? reordered(source, encoding)
                            : bgr_of_yuv(source, encoding);
}

image_view to_plain_numbers(const image_view& source, bytes& storage) {
  const auto encoding = ros2::find_encoding(source.encoding);
  if (!encoding)
    throw engine::unusable_input("images in encoding '" + source.encoding
                                 + "', of which nothing is known; have the "
                                   "camera send one that skills/README.md "
                                   "lists");
  if (is_plain(*encoding)) {
    if (encoding->bits == 8 || !is_swapped(source))
      return source;
    storage = turned(source, *encoding);
    return view_of(source, source.encoding.c_str(), storage);
  }
  if (encoding->bits == 16) {
    storage = bgr_of_mosaic<std::uint16_t>(source, *encoding);
    return view_of(source, "bgr16", storage);
  }
  storage = encoding->form == pixel_form::mosaic
                ? bgr_of_mosaic<std::uint8_t>(source, *encoding)
                : bgr_of_yuv(source, *encoding);
  return view_of(source, "bgr8", storage);
}

} // namespace roscell::vision
