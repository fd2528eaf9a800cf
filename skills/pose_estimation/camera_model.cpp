#include "skills/pose_estimation/camera_model.hpp"

#include <algorithm>
#include <cmath>

namespace roscell::pose {

namespace {

bool all_zero(const ros2::sensor_msgs::camera_info& info) {
  auto zero = [](double x) { return x == 0; };
  return std::all_of(info.k.begin(), info.k.end(), zero)
         && std::all_of(info.p.begin(), info.p.end(), zero);
}

bool makes_sense(double fx, double fy, double cx, double cy) {
  return std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx)
         && std::isfinite(cy) && fx > 0 && fy > 0;
}

} // namespace

std::variant<camera_model, std::string>
camera_model::of(const ros2::sensor_msgs::camera_info& info, bool rectified) {
  if (all_zero(info))
    return "is all zero, so the camera is not calibrated; calibrate it, or "
           "give the parameters 'fx', 'fy', 'cx' and 'cy'";
  auto model = rectified
                   ? camera_model{info.p[0], info.p[5], info.p[2], info.p[6]}
                   : camera_model{info.k[0], info.k[4], info.k[2], info.k[5]};
  if (!makes_sense(model.focal_.x(), model.focal_.y(), model.centre_.x(),
                   model.centre_.y()))
    return std::string{"has no positive focal lengths in "}
           + (rectified ? "P" : "K")
           + "; calibrate the camera, or give the parameters 'fx', 'fy', 'cx' "
             "and 'cy'";
  if (rectified)
    return model;
  auto lens = vision::lens::of(info);
  if (auto* wrong = std::get_if<std::string>(&lens))
    return *wrong;
  model.lens_ = std::get<vision::lens>(lens);
  return model;
}

Eigen::Vector2d camera_model::project(const Eigen::Vector3d& point) const {
  return to_pixel(point.head<2>() / point.z());
}

Eigen::Vector2d camera_model::distort(const Eigen::Vector2d& pixel) const {
  if (!lens_.distorts())
    return pixel;
  const auto direction = normalize(pixel);
  const auto seen = lens_.bend({direction.x(), direction.y()});
  return to_pixel({seen.x, seen.y});
}

Eigen::Vector2d camera_model::undistort(const Eigen::Vector2d& pixel) const {
  if (!lens_.distorts())
    return pixel;
  const auto seen = normalize(pixel);
  const auto direction = lens_.straighten({seen.x(), seen.y()});
  return to_pixel({direction.x, direction.y});
}

} // namespace roscell::pose
