#include "skills/pose_estimation/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <string>

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

namespace {

constexpr int dots_wide = 5;
constexpr int dots_high = 7;

/// One byte per row of dots; the highest of five bits is the left dot.
constexpr std::uint8_t digit_rows[10][dots_high] = {
    {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e},
    {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e},
    {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f},
    {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e},
    {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02},
    {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e},
    {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e},
    {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08},
    {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e},
    {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c},
};

double distance(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                const Eigen::Vector2d& to) {
  Eigen::Vector2d along = to - from;
  auto length2 = along.squaredNorm();
  auto t = length2 > 0 ? (point - from).dot(along) / length2 : 0.0;
  return (from + std::clamp(t, 0.0, 1.0) * along - point).norm();
}

std::uint8_t mix(std::uint8_t below, std::uint8_t above, double share) {
  return static_cast<std::uint8_t>(
      std::lround(below + share * (above - below)));
}

} // namespace

void canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                  double width_px, colour ink) {
  if (!from.allFinite() || !to.allFinite())
    return;
  auto reach = width_px / 2 + 1;
  // Clamped before the conversion, because a pixel may be anywhere.
  auto within = [](double x, std::uint32_t size) {
    return static_cast<int>(std::clamp(x, -1.0, static_cast<double>(size)));
  };
  auto left = within(std::min(from.x(), to.x()) - reach, target_.width);
  auto right = within(std::max(from.x(), to.x()) + reach, target_.width);
  auto top = within(std::min(from.y(), to.y()) - reach, target_.height);
  auto bottom = within(std::max(from.y(), to.y()) + reach, target_.height);
  for (auto y = top; y <= bottom; ++y)
    for (auto x = left; x <= right; ++x)
      blend(x, y,
            width_px / 2 + 0.5 - distance(Eigen::Vector2d(x, y), from, to),
            ink);
}

void canvas::number(const Eigen::Vector2d& centre, unsigned value, int dot_px,
                    colour ink) {
  auto digits = std::to_string(value);
  auto advance = (dots_wide + 1) * dot_px;
  auto width = static_cast<int>(digits.size()) * advance - dot_px;
  auto height = dots_high * dot_px;
  auto left = static_cast<int>(centre.x()) - width / 2;
  auto top = static_cast<int>(centre.y()) - height / 2;
  fill(left - dot_px, top - dot_px, width + 2 * dot_px, height + 2 * dot_px,
       0.7, {0, 0, 0});
  for (auto c : digits) {
    digit(left, top, static_cast<unsigned>(c - '0'), dot_px, ink);
    left += advance;
  }
}

void canvas::blend(int x, int y, double share, colour ink) {
  if (!(share > 0) || x < 0 || y < 0 || x >= static_cast<int>(target_.width)
      || y >= static_cast<int>(target_.height))
    return;
  share = std::min(share, 1.0);
  auto* pixel = &target_.pixels[static_cast<std::size_t>(y) * target_.step()
                                + static_cast<std::size_t>(x) * 3];
  pixel[0] = mix(pixel[0], ink.blue, share);
  pixel[1] = mix(pixel[1], ink.green, share);
  pixel[2] = mix(pixel[2], ink.red, share);
}

void canvas::fill(int left, int top, int width, int height, double share,
                  colour ink) {
  for (auto y = top; y < top + height; ++y)
    for (auto x = left; x < left + width; ++x)
      blend(x, y, share, ink);
}

void canvas::digit(int left, int top, unsigned value, int dot_px, colour ink) {
  for (auto row = 0; row < dots_high; ++row)
    for (auto column = 0; column < dots_wide; ++column)
      if ((digit_rows[value][row] >> (dots_wide - 1 - column) & 1) != 0)
        fill(left + column * dot_px, top + row * dot_px, dot_px, dot_px, 1,
             ink);
}

} // namespace roscell::pose
