#include "skills/pose_estimation/camera_source.hpp"

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

} // namespace roscell::pose
