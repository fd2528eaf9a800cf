#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace roscell::ros2 {

/// What the numbers of an image mean.
enum class pixel_form : std::uint8_t {
  gray,       ///< One number a pixel, its brightness.
  colours,    ///< Blue, green and red of each pixel, and perhaps its opacity.
  mosaic,     ///< One number a pixel, of one colour: Bayer.
  packed_yuv, ///< Brightness of each pixel, colour of two, by turns.
  planar_yuv, ///< Brightness of all pixels, then their colours.
  numbers,    ///< Nothing says what they mean.
};

enum class number_form : std::uint8_t { unsigned_whole, signed_whole, real };

/// How the colours of `planar_yuv` follow its brightness.
enum class chroma_form : std::uint8_t {
  uv_pairs, ///< U and V by turns, one pair for 2 x 2 pixels: NV12.
  vu_pairs, ///< The same with V first: NV21.
  uv_full,  ///< U and V by turns, one pair a pixel: NV24.
  planes,   ///< All U, then all V, one of each for 2 x 2 pixels: I420.
};

/// An encoding of sensor_msgs/image_encodings.hpp, or I420, which some drivers
/// send beside them.
struct image_encoding {
  pixel_form form = pixel_form::numbers;
  std::uint8_t channels = 1; ///< Numbers of a pixel in its row.
  std::uint8_t bits = 8;     ///< Of a number.
  number_form numbers = number_form::unsigned_whole;
  std::uint8_t blue = 0;  ///< Of `colours`: which number is blue; green is 1.
  std::uint8_t red = 0;   ///< Of `colours`: which number is red.
  std::uint8_t red_x = 0; ///< Of `mosaic`: the column of a red pixel, 0 or 1.
  std::uint8_t red_y = 0; ///< Of `mosaic`: its row, 0 or 1.
  std::uint8_t luma = 0;  ///< Of `packed_yuv`: which number is brightness.
  chroma_form chroma = chroma_form::uv_pairs; ///< Of `planar_yuv`.

  /// In a row; the rows of `planar_yuv` are those of brightness.
  std::uint32_t bytes_per_pixel() const noexcept {
    return static_cast<std::uint32_t>(channels) * bits / 8;
  }

  /// Whether each pixel's brightness is known: all but `numbers`.
  bool is_picture() const noexcept {
    return form != pixel_form::numbers;
  }

  /// Bytes of an image with rows of `step` bytes, colours included. `step`
  /// times `height` is less than 2^62.
  std::uint64_t bytes_of(std::uint64_t step, std::uint64_t height) const;
};

/// Nothing if the name is unknown. OpenCV's matrices ("8UC3", "32FC1", "16U")
/// are gray with one channel; those with three or four of 8 or 16 bits without
/// sign are coloured in OpenCV's order, blue first; all others are `numbers`.
/// Other names are known in capitals, too.
std::optional<image_encoding> find_encoding(std::string_view name);

} // namespace roscell::ros2
