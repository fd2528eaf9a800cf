#pragma once

#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/parameters.hpp"
#include "skills/vision/image_codec.hpp"

#include <string>

namespace roscell::vision {

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
