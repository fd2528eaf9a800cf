#pragma once

#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/skill/parameters.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::vision {

/// 8 bits per channel; the values are the bytes of a pixel.
enum class pixel_format : std::uint8_t { mono8 = 1, bgr8 = 3 };

/// The name in ROS: "mono8" or "bgr8".
const char* encoding_name(pixel_format format);

/// A picture whose rows follow each other without gaps.
struct picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  pixel_format format = pixel_format::mono8;
  std::vector<std::uint8_t> pixels;

  std::size_t step() const noexcept {
    return std::size_t{width} * static_cast<std::size_t>(format);
  }
};

/// The picture as a ROS message without a copy of its pixels, which must live
/// as long as the result.
ros2::image_view view(const picture& source, ros2::std_msgs::header header);

/// Bytes that are no picture, or one that is too large. The text is for people.
struct image_error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A larger picture is refused before memory is taken: a few bytes of PNG may
/// stand for gigabytes. Twice as much as an 8K camera gives.
constexpr std::uint64_t max_picture_pixels = 64'000'000;

/// Decodes a PNG or JPEG file; transparency becomes white, more than 8 bits
/// per channel are cut. Throws image_error.
picture decode_picture(std::string_view file, pixel_format wanted);

/// Compress an image of mono8 or bgr8, PNG fast rather than well; `quality` is
/// that of JPEG, 1 to 100. Both throw image_error.
std::string encode_png(const ros2::image_view& source);
std::string encode_jpeg(const ros2::image_view& source, int quality);

inline std::string encode_png(const picture& source) {
  return encode_png(view(source, {}));
}

/// How images become sensor_msgs/msg/CompressedImage, from the parameters of a
/// skill:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | compressed_format | jpeg | or png, which loses nothing
/// | jpeg_quality | 95 | 1 to 100
class compression {
public:
  /// Throws start_error when a parameter makes no sense.
  explicit compression(const engine::parameters& options);

  /// An image of mono8 or bgr8, its format called as image_transport has it:
  /// "bgr8; jpeg compressed bgr8". Throws image_error.
  ros2::sensor_msgs::compressed_image
  compress(const ros2::image_view& image) const;

private:
  const std::string format_;
  const int jpeg_quality_;
};

/// The picture in a message of any sender; its bytes say whether they are PNG
/// or JPEG. Throws image_error.
picture decompress(const ros2::sensor_msgs::compressed_image& message,
                   pixel_format wanted);

} // namespace roscell::vision
