#pragma once

#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/skill/executor.hpp"
#include "roscell/skill/handlers.hpp"
#include "roscell/skill/typed_ports.hpp"
#include "skills/vision/complaint.hpp"
#include "skills/vision/image_codec.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roscell::source {

/// Makes a camera out of pictures: PNG and JPEG files, or a video.
///
/// Inputs: pictures (image/png, image/jpeg by protocol `file`, or
/// sensor_msgs/msg/Image by protocol `video`). Outputs, by data type:
/// sensor_msgs/msg/Image, sensor_msgs/msg/CompressedImage and
/// sensor_msgs/msg/CameraInfo; the k-th input feeds the k-th output of each
/// type. The messages of a picture bear the same stamp: when it is sent, or
/// when the video gave it.
///
/// Intrinsics come from the parameters fx, fy, cx, cy, or from a calibration
/// beside the pictures (see vision/calibration.hpp); without both, CameraInfo
/// is all zero but for its size, as ROS has it for a camera that is not
/// calibrated. Further parameters, beside `rate_hz` and `loop` of the protocol
/// and those of vision/image_codec.hpp:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | encoding | mono8 | of the images: mono8 or bgr8
/// | frame_id | camera | frame of the images
///
/// A file that is no picture is said once and skipped.
class image_source : public engine::executor {
public:
  explicit image_source(const engine::environment& env);

  /// `say` gets the lines for people.
  image_source(const engine::environment& env, engine::say_function say);

  void process(const engine::frame& input, engine::emitter& output) override;

  void release() override;

private:
  /// One input, with what belongs to it.
  struct camera {
    std::string name;
    std::optional<ros2::sensor_msgs::camera_info> calibration;
    std::size_t images = engine::typed_outputs::none;
    std::size_t compressed = engine::typed_outputs::none;
    std::size_t infos = engine::typed_outputs::none;
    bool size_said = false;
  };

  void add_camera(const engine::environment& env, const engine::stream& input);
  void process_file(const engine::frame& input, camera& eye,
                    engine::emitter& output);
  void emit_beside(camera& eye, const ros2::image_view& image,
                   const engine::frame& input, engine::emitter& output);
  void emit_info(camera& eye, const ros2::image_view& image,
                 const engine::frame& input, engine::emitter& output);

  const engine::say_function say_;
  const std::string frame_id_;
  const vision::pixel_format format_;
  const vision::compression compression_;
  vision::broken_files broken_files_;
  std::vector<camera> cameras_;
};

} // namespace roscell::source
