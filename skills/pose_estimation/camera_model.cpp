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

/// What is wrong with the distortion, or nothing.
std::string check_distortion(const ros2::sensor_msgs::camera_info& info) {
  const auto& model = info.distortion_model;
  if (!std::all_of(info.d.begin(), info.d.end(),
                   [](double x) { return std::isfinite(x); }))
    return "holds a distortion that is no number; calibrate the camera";
  if (std::all_of(info.d.begin(), info.d.end(),
                  [](double x) { return x == 0; }))
    return "";
  auto most = model == "rational_polynomial" ? 8U : 5U;
  if (model != "plumb_bob" && model != "rational_polynomial")
    return "has the distortion model '" + model
           + "', which is none of plumb_bob and rational_polynomial; rectify "
             "the image first and set the parameter 'rectified'";
  if (info.d.size() > most)
    return "has " + std::to_string(info.d.size()) + " distortion coefficients, "
           + "but " + model + " has " + std::to_string(most)
           + "; calibrate the camera";
  return "";
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
  if (auto wrong = check_distortion(info); !wrong.empty())
    return wrong;
  std::copy_n(info.d.begin(), std::min<std::size_t>(info.d.size(), 8),
              model.distortion_.begin());
  model.distorted_ = std::any_of(info.d.begin(), info.d.end(),
                                 [](double x) { return x != 0; });
  return model;
}

Eigen::Vector2d camera_model::project(const Eigen::Vector3d& point) const {
  return to_pixel(point.head<2>() / point.z());
}

camera_model::bend
camera_model::bend_at(const Eigen::Vector2d& direction) const {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = distortion_;
  auto x = direction.x();
  auto y = direction.y();
  auto r2 = direction.squaredNorm();
  auto radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))
                / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {radial,
          {2 * p1 * x * y + p2 * (r2 + 2 * x * x),
           p1 * (r2 + 2 * y * y) + 2 * p2 * x * y}};
}

Eigen::Vector2d camera_model::distort(const Eigen::Vector2d& pixel) const {
  if (!distorted_)
    return pixel;
  auto direction = normalize(pixel);
  auto b = bend_at(direction);
  return to_pixel(direction * b.radial + b.tangential);
}

Eigen::Vector2d camera_model::undistort(const Eigen::Vector2d& pixel) const {
  if (!distorted_)
    return pixel;
  // Far below the noise of any corner. Strong lenses need some 20 turns.
  constexpr auto enough = 1e-10;
  constexpr auto most_turns = 100;
  Eigen::Vector2d seen = normalize(pixel);
  Eigen::Vector2d direction = seen;
  for (auto i = 0; i < most_turns; ++i) {
    auto b = bend_at(direction);
    Eigen::Vector2d next = (seen - b.tangential) / b.radial;
    auto change = (next - direction).norm();
    direction = next;
    if (change < enough)
      break;
  }
  return to_pixel(direction);
}

ros2::sensor_msgs::camera_info
describe_sent_images(ros2::sensor_msgs::camera_info info) {
  // Zero means the whole image, and zero binning none.
  const auto& part = info.roi;
  if (part.width != 0 && part.height != 0) {
    info.width = part.width;
    info.height = part.height;
    info.k[2] -= part.x_offset;
    info.k[5] -= part.y_offset;
    info.p[2] -= part.x_offset;
    info.p[6] -= part.y_offset;
  }
  auto across = std::max(info.binning_x, 1U);
  auto down = std::max(info.binning_y, 1U);
  info.width /= across;
  info.height /= down;
  for (auto i : {0, 2}) {
    info.k[i] /= across;
    info.p[i] /= across;
  }
  for (auto i : {4, 5})
    info.k[i] /= down;
  for (auto i : {5, 6})
    info.p[i] /= down;
  info.roi = {};
  info.binning_x = 0;
  info.binning_y = 0;
  return info;
}

} // namespace roscell::pose
