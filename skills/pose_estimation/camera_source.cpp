#include "skills/pose_estimation/camera_source.hpp"

#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/ros2/vision_msgs.hpp"
#include "roscell/skill/errors.hpp"

#include <utility>

namespace roscell::pose {

namespace {

/// Images and CameraInfo come on different ways, so a few images may overtake
/// the first CameraInfo of a healthy camera.
constexpr auto patient_images = 5U;

bool same_calibration(const ros2::sensor_msgs::camera_info& a,
                      const ros2::sensor_msgs::camera_info& b) {
  return a.width == b.width && a.height == b.height && a.k == b.k && a.p == b.p
         && a.d == b.d && a.distortion_model == b.distortion_model;
}

std::string size(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

} // namespace

camera_source::camera_source(const std::string& name, bool expects_info,
                             bool rectified, engine::say_function say)
    : name_(name), say_(say), expects_info_(expects_info),
      rectified_(rectified),
      complaint_("'" + name + "' gives detections without poses: ",
                 "'" + name
                     + "': the camera's intrinsics are good now, poses follow",
                 std::move(say)) {
  // nop
}

void camera_source::calibrate(stamp at,
                              const ros2::sensor_msgs::camera_info& sent) {
  calibrations_.add(at, sent);
}

void camera_source::use(const ros2::sensor_msgs::camera_info& sent) {
  auto info = vision::describe_sent_images(sent);
  // It comes with every image, and hardly ever changes.
  if (info_ && same_calibration(*info_, info))
    return;
  if (info_ && model_ && !std::exchange(change_said_, true))
    say_(
        "'" + name_
        + "': its calibration changes while it runs; each image is measured by "
          "the CameraInfo of its stamp");
  info_ = info;
  model_.reset();
  fault_.clear();
  auto read = camera_model::of(info, rectified_);
  if (auto* fault = std::get_if<std::string>(&read))
    fault_ = "its CameraInfo " + *fault;
  else
    model_ = std::get<camera_model>(read);
}

std::optional<camera_model> camera_source::model_for(stamp image,
                                                     std::uint32_t width,
                                                     std::uint32_t height) {
  if (const auto* known = calibrations_.of(image))
    use(*known);
  if (!info_ && expects_info_ && ++early_images_ < patient_images)
    return std::nullopt;
  auto problem = problem_with(width, height);
  complaint_.update(problem);
  return problem.empty() ? model_ : std::nullopt;
}

std::string camera_source::problem_with(std::uint32_t width,
                                        std::uint32_t height) const {
  if (!info_ && expects_info_)
    return "no CameraInfo has come; see that the camera publishes it, or give "
           "the parameters 'fx', 'fy', 'cx' and 'cy'";
  if (!info_)
    return "the camera's intrinsics are not known; add its CameraInfo as an "
           "input, put a camera.json beside the images, or give the parameters "
           "'fx', 'fy', 'cx' and 'cy'";
  if (!model_)
    return fault_;
  // Intrinsics from parameters hold for any size.
  if ((info_->width != 0 && info_->width != width)
      || (info_->height != 0 && info_->height != height))
    return "its CameraInfo is for images of "
           + size(info_->width, info_->height) + ", but they have "
           + size(width, height) + " pixels; calibrate the camera at this size";
  return "";
}

using engine::start_error;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::compressed_image;
using ros2::sensor_msgs::image;

bool is_camera_info(const engine::stream& input) {
  return input.data_type == camera_info::type_name;
}

bool is_image_message(const std::string& data_type) {
  return data_type == image::type_name
         || data_type == compressed_image::type_name;
}

void check_streams(const engine::environment& env) {
  for (const auto& in : env.inputs)
    if (!is_camera_info(in) && !is_image_message(in.data_type)
        && in.data_type.compare(0, 6, "image/") != 0)
      throw start_error("input '" + in.endpoint + "' has the type '"
                        + in.data_type
                        + "'; this skill takes sensor_msgs/msg/Image, "
                          "sensor_msgs/msg/CompressedImage, image/png, "
                          "image/jpeg and sensor_msgs/msg/CameraInfo");
  for (const auto& out : env.outputs)
    if (out.data_type != ros2::tf2_msgs::tf_message::type_name
        && out.data_type
               != ros2::apriltag_msgs::april_tag_detection_array::type_name
        && out.data_type != ros2::vision_msgs::detection3_d_array::type_name
        && out.data_type != "application/json" && out.data_type != "image/png")
      throw start_error("output '" + out.endpoint + "' has the type '"
                        + out.data_type
                        + "'; this skill gives tf2_msgs/msg/TFMessage, "
                          "apriltag_msgs/msg/AprilTagDetectionArray, "
                          "vision_msgs/msg/Detection3DArray, "
                          "application/json and image/png");
}

std::vector<std::string> texts_of_cameras(const engine::parameters& options,
                                          const char* name,
                                          std::size_t cameras) {
  auto result = options.texts(name, {}, 64);
  if (!result.empty() && result.size() != cameras)
    throw start_error("parameter '" + std::string{name} + "' has "
                      + std::to_string(result.size()) + " texts, but the step "
                      + std::to_string(cameras)
                      + " image inputs; give one for each, in their order");
  result.resize(cameras);
  return result;
}

} // namespace roscell::pose
