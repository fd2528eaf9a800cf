#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/log_line.hpp"
#include "roscell/skill/pacer.hpp"
#include "roscell/skill/typed_ports.hpp"
#include "skills/pose_estimation/camera_source.hpp"
#include "skills/pose_estimation/frame_result.hpp"
#include "skills/pose_estimation/tag_finder.hpp"
#include "skills/vision/complaint.hpp"
#include "skills/vision/image_codec.hpp"
#include "skills/vision/paired_executor.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roscell::pose {

/// Finds AprilTags in images and tells where they are.
///
/// Inputs: images (sensor_msgs/msg/Image, sensor_msgs/msg/CompressedImage,
/// image/png, image/jpeg) and CameraInfo (sensor_msgs/msg/CameraInfo); the k-th
/// CameraInfo input belongs to the k-th image input. Outputs, by data type:
/// tf2_msgs/msg/TFMessage, apriltag_msgs/msg/AprilTagDetectionArray,
/// vision_msgs/msg/Detection3DArray (poses with covariance),
/// application/json (see `frame_result`) and image/png (see `draw_overlay`);
/// the k-th image input feeds the k-th output of each type, or its only one.
///
/// Intrinsics come from the parameters fx, fy, cx, cy (see
/// vision/calibration.hpp), else from CameraInfo, else from a calibration
/// beside the images. Further parameters, beside those of `detector_options`:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | tag_size_m | 0.08 | side of the square whose corners AprilTag finds
/// | bundles | [] | bodies with several tags, see `bundles_of`
/// | frame_ids | [] | of the k-th camera, in place of what its images say
/// | tag_prefixes | [] | before child frames of the k-th camera
/// | rectified | false | images are rectified: P of CameraInfo counts, and no
///   distortion
/// | frame_id | camera | frame of images that bring none, i.e. of files
/// | picture_rate_hz | 1 | of a topic or video, at most so many pictures per
///   second are drawn, each in the place of the one before, so that they do not
///   fill a disk; 0: every picture under its own name. Files always get all
/// | encodings | all of them | see vision/complaint.hpp
///
/// A file that is no image is said once and skipped. An image whose message is
/// broken fails. One in an encoding that cannot be used ends the skill.
class pose_estimator : public vision::paired_executor {
public:
  explicit pose_estimator(const engine::environment& env);

  /// `say` gets the lines for people.
  pose_estimator(const engine::environment& env, engine::say_function say);

  /// How tags are looked for can be changed: decimation, blur, refine,
  /// sharpening and threads.
  void on_parameters(const engine::parameters& now) override {
    finder_.adjust(now);
  }

  void release() override;

private:
  /// One image input, with what belongs to it.
  struct source {
    camera_source camera;
    std::string name;      ///< What people call it.
    std::string frame_id;  ///< Of its results; empty: that of the image.
    std::string prefix;    ///< Of child frames.
    std::string live_name; ///< Of its pictures, if each replaces the last.
    engine::pacer picture_pace;
    std::size_t transforms = engine::typed_outputs::none;
    std::size_t detections = engine::typed_outputs::none;
    std::size_t poses = engine::typed_outputs::none;
    std::size_t lines = engine::typed_outputs::none;
    std::size_t pictures = engine::typed_outputs::none;
  };

  void add_sources(const engine::environment& env);
  void add_source(const engine::environment& env, std::size_t port,
                  bool expects_info);
  static vision::pixel_format format_for(const source& from);
  void calibrate(std::size_t camera, const engine::frame& info) override;
  bool should_wait(std::size_t camera, const engine::frame& image) override;
  void process_image(const engine::frame& input,
                     engine::emitter& output) override;
  void process_file(const engine::frame& input, engine::emitter& output);
  void process_compressed(const engine::frame& input, engine::emitter& output);
  void find_and_emit(const ros2::image_view& image, const engine::frame& input,
                     engine::emitter& output);
  void emit_picture(source& from, const frame_result& result,
                    const ros2::image_view& image,
                    const std::optional<camera_model>& camera,
                    engine::emitter& output);
  frame_result find_tags(const ros2::image_view& image, std::size_t number,
                         const std::optional<camera_model>& camera);
  vision::picture draw(const frame_result& result,
                       const ros2::image_view& image,
                       const std::optional<camera_model>& camera) const;

  const engine::say_function say_;
  const bool rectified_;
  const std::string frame_id_;
  const double picture_rate_hz_;
  /// From the parameters; CameraInfo then does not count.
  const std::optional<ros2::sensor_msgs::camera_info> given_;
  const vision::accepted_encodings accepted_;
  tag_finder finder_;
  std::vector<source> sources_;
  std::vector<std::uint8_t> gray_buffer_;
  vision::broken_files broken_files_;
};

} // namespace roscell::pose
