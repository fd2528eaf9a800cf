#include "skills/vision/lens.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace roscell::vision {

namespace {

using ros2::sensor_msgs::camera_info;
using row_major = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Without zeros at the end.
std::size_t used_coefficients(const std::vector<double>& d) {
  const auto last =
      std::find_if(d.rbegin(), d.rend(), [](double x) { return x != 0; });
  return static_cast<std::size_t>(d.rend() - last);
}

bool is_equidistant(const camera_info& info) {
  return info.distortion_model == "equidistant"
         || info.distortion_model == "fisheye";
}

bool is_polynomial(const camera_info& info) {
  return info.distortion_model == "plumb_bob"
         || info.distortion_model == "rational_polynomial";
}

/// What is wrong with the coefficients, or nothing.
std::string problem_of(const camera_info& info) {
  const auto given = info.d.size();
  const auto used = used_coefficients(info.d);
  const auto amount =
      "has " + std::to_string(given) + " distortion coefficients, but ";
  if (!is_equidistant(info) && !is_polynomial(info))
    return "has the distortion model '" + info.distortion_model
           + "', which is none of plumb_bob, rational_polynomial and "
             "equidistant; calibrate the camera with one of these";
  if (is_equidistant(info))
    return used <= 4 ? ""
                     : amount + info.distortion_model
                           + " has 4; calibrate the camera";
  const auto is_known = used <= 5 || given == 8 || given == 12 || given == 14
                        || (used <= 14 && given > 14);
  return is_known ? ""
                  : amount + info.distortion_model
                        + " has 4, 5, 8, 12 or 14; calibrate the camera";
}

lens::point through(const std::array<double, 9>& m, const lens::point& p) {
  const auto depth = m[6] * p.x + m[7] * p.y + m[8];
  return {(m[0] * p.x + m[1] * p.y + m[2]) / depth,
          (m[3] * p.x + m[4] * p.y + m[5]) / depth};
}

} // namespace

std::variant<lens, std::string> lens::of(const camera_info& info) {
  const auto& d = info.d;
  if (!std::all_of(d.begin(), d.end(),
                   [](double x) { return std::isfinite(x); }))
    return "holds a distortion that is no number; calibrate the camera";
  const auto used = used_coefficients(d);
  // An equidistant lens bends without any coefficients.
  if (d.empty() || (used == 0 && !is_equidistant(info)))
    return lens{};
  if (auto problem = problem_of(info); !problem.empty())
    return problem;
  lens result;
  result.kind_ = is_equidistant(info) ? kind::equidistant : kind::polynomial;
  std::copy_n(d.begin(), std::min(used, result.coefficients_.size()),
              result.coefficients_.begin());
  if (used > result.coefficients_.size())
    result.tilt(d[12], used > 13 ? d[13] : 0);
  return result;
}

/// The matrix of OpenCV's computeTiltProjectionMatrix.
void lens::tilt(double tau_x, double tau_y) {
  row_major about_x;
  about_x << 1, 0, 0, 0, std::cos(tau_x), std::sin(tau_x), 0, -std::sin(tau_x),
      std::cos(tau_x);
  row_major about_y;
  about_y << std::cos(tau_y), 0, -std::sin(tau_y), 0, 1, 0, std::sin(tau_y), 0,
      std::cos(tau_y);
  const row_major turn = about_y * about_x;
  row_major onto_sensor;
  onto_sensor << turn(2, 2), 0, -turn(0, 2), 0, turn(2, 2), -turn(1, 2), 0, 0,
      1;
  const row_major result = onto_sensor * turn;
  const row_major back = result.inverse();
  std::copy_n(result.data(), 9, tilt_.begin());
  std::copy_n(back.data(), 9, untilt_.begin());
  tilted_ = true;
}

lens::point lens::bend(const point& straight) const {
  if (kind_ == kind::equidistant)
    return bend_equidistant(straight);
  if (kind_ == kind::none)
    return straight;
  const auto by = change_at(straight);
  const point result{straight.x * by.radial + by.x,
                     straight.y * by.radial + by.y};
  return tilted_ ? through(tilt_, result) : result;
}

/// Fixed-point iteration, as cv::undistortPoints does it.
lens::point lens::straighten(const point& bent) const {
  if (kind_ == kind::equidistant)
    return straighten_equidistant(bent);
  if (kind_ == kind::none)
    return bent;
  // Far below the noise of any corner. Strong lenses need some 20 turns.
  constexpr auto enough = 1e-10;
  constexpr auto most_turns = 100;
  const auto seen = tilted_ ? through(untilt_, bent) : bent;
  auto result = seen;
  for (auto i = 0; i < most_turns; ++i) {
    const auto by = change_at(result);
    const point next{(seen.x - by.x) / by.radial, (seen.y - by.y) / by.radial};
    const auto moved = std::hypot(next.x - result.x, next.y - result.y);
    result = next;
    if (moved < enough)
      break;
  }
  return result;
}

lens::change lens::change_at(const point& straight) const {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4] = coefficients_;
  const auto [x, y] = straight;
  const auto r2 = x * x + y * y;
  const auto radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))
                      / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {radial, 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + r2 * (s1 + r2 * s2),
          p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + r2 * (s3 + r2 * s4)};
}

lens::point lens::bend_equidistant(const point& straight) const {
  const auto r = std::hypot(straight.x, straight.y);
  if (r == 0)
    return straight;
  const auto& k = coefficients_;
  const auto angle = std::atan(r);
  const auto a2 = angle * angle;
  const auto seen =
      angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
  return {straight.x * seen / r, straight.y * seen / r};
}

/// The angle by Newton's method.
lens::point lens::straighten_equidistant(const point& bent) const {
  const auto seen = std::hypot(bent.x, bent.y);
  if (seen == 0)
    return bent;
  const auto& k = coefficients_;
  constexpr auto most_turns = 50;
  constexpr auto enough = 1e-12;
  constexpr auto widest = 1.55; // Radians; a plane ends at pi / 2.
  auto angle = std::min(seen, widest);
  auto off = 1.0;
  for (auto i = 0; i < most_turns && std::abs(off) > enough; ++i) {
    const auto a2 = angle * angle;
    const auto here =
        angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
    const auto slope =
        1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])));
    off = (here - seen) / slope;
    angle -= off;
  }
  if (!(std::abs(off) <= enough && angle > 0 && angle < widest)) {
    constexpr auto none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  const auto scale = std::tan(angle) / seen;
  return {bent.x * scale, bent.y * scale};
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

} // namespace roscell::vision
