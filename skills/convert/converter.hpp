#pragma once

#include "roscell/ros2/image_view.hpp"
#include "roscell/skill/environment.hpp"
#include "roscell/skill/executor.hpp"
#include "skills/vision/complaint.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell::convert {

/// Sends images on in an encoding that others can read.
///
/// Inputs: sensor_msgs/msg/Image in any encoding that pose_estimation takes, or
/// sensor_msgs/msg/CompressedImage. Outputs: sensor_msgs/msg/Image with the
/// same header, as many as inputs or one; the k-th input feeds the k-th.
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | encoding | bgr8 | of what is sent: mono8, rgb8 or bgr8
/// | encodings | all of them | see vision/complaint.hpp
///
/// An encoding of which nothing says how bright a pixel is ends the skill.
class converter : public engine::executor {
public:
  explicit converter(const engine::environment& env);

  void process(const engine::frame& input, engine::emitter& output) override;

  void release() override;

private:
  ros2::image_view converted(const ros2::image_view& source);

  const std::string encoding_;
  const vision::accepted_encodings accepted_;
  std::vector<std::size_t> outputs_; ///< By input port.
  std::vector<std::uint8_t> pixels_;
};

} // namespace roscell::convert
