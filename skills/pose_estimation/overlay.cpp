#include "skills/pose_estimation/overlay.hpp"

#include "skills/pose_estimation/canvas.hpp"

#include <algorithm>

namespace roscell::pose {

namespace {

constexpr colour yellow{0, 255, 255};
constexpr colour magenta{255, 0, 255};
constexpr colour white{255, 255, 255};
constexpr colour red{0, 0, 255};
constexpr colour green{0, 255, 0};
constexpr colour blue{255, 64, 0};

/// Lines of 2 pixels at 640 pixels across, thicker in larger pictures.
double line_width(const vision::picture& target) {
  return std::max(1.5, target.width / 320.0);
}

void draw_outline(const tag_corners& corners, double width_px, canvas& target) {
  for (std::size_t i = 0; i < 4; ++i)
    target.line(corners[i], corners[(i + 1) % 4], width_px,
                i == 0 ? magenta : yellow);
}

/// Between the middle, where the axes begin, and the bottom edge.
void draw_id(int id, const tag_corners& corners, canvas& target) {
  Eigen::Vector2d bottom = (corners[0] + corners[1]) / 2;
  Eigen::Vector2d top = (corners[2] + corners[3]) / 2;
  auto side = (corners[1] - corners[0]).norm();
  auto dot_px = std::clamp(static_cast<int>(side / 32), 1, 8);
  target.number(bottom * 0.75 + top * 0.25, static_cast<unsigned>(id), dot_px,
                white);
}

void draw_axes(const tag_pose& pose, double length_m,
               const camera_model& camera, double width_px, canvas& target) {
  auto pixel = [&](const Eigen::Vector3d& point) -> Eigen::Vector2d {
    return camera.distort(
        camera.project(pose.orientation * point + pose.position));
  };
  const colour inks[] = {red, green, blue};
  for (auto i = 0; i < 3; ++i) {
    Eigen::Vector3d tip = Eigen::Vector3d::Unit(i) * length_m;
    if ((pose.orientation * tip + pose.position).z() > 0)
      target.line(pixel(Eigen::Vector3d::Zero()), pixel(tip), width_px,
                  inks[i]);
  }
}

} // namespace

void draw_overlay(const frame_result& result,
                  const std::optional<camera_model>& camera,
                  vision::picture& target) {
  canvas drawing{target};
  auto width_px = line_width(target);
  for (const auto& tag : result.tags) {
    auto corners = tag.detection.camera_corners();
    draw_outline(corners, width_px, drawing);
    draw_id(tag.detection.id, corners, drawing);
    if (tag.pose && camera)
      draw_axes(*tag.pose, tag.size_m / 2, *camera, width_px, drawing);
  }
}

} // namespace roscell::pose
