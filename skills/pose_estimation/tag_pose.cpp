#include "skills/pose_estimation/tag_pose.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>
#include <limits>

namespace roscell::pose {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using vector8d = Eigen::Matrix<double, 8, 1>;
using matrix8d = Eigen::Matrix<double, 8, 8>;

/// The H with H (x, y, 1) ~ (u, v, 1) for the points of the tag (x, y) and the
/// directions (u, v), with H(2,2) = 1, which holds for every tag in front of
/// the camera: there it is the depth of the tag's middle, scaled.
std::optional<Matrix3d> homography(const std::array<Vector3d, 4>& points,
                                   const std::array<Vector2d, 4>& directions) {
  matrix8d a = matrix8d::Zero();
  vector8d b;
  for (auto i = 0; i < 4; ++i) {
    auto x = points[i].x();
    auto y = points[i].y();
    auto [u, v] = std::pair{directions[i].x(), directions[i].y()};
    a.row(2 * i) << x, y, 1, 0, 0, 0, -u * x, -u * y;
    a.row(2 * i + 1) << 0, 0, 0, x, y, 1, -v * x, -v * y;
    b.segment<2>(2 * i) << u, v;
  }
  Eigen::FullPivLU<matrix8d> lu{a};
  if (!lu.isInvertible())
    return std::nullopt;
  vector8d h = lu.solve(b);
  Matrix3d result;
  result << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return result;
}

/// The rigid transform nearest to a homography: its first two columns are
/// scaled columns of the rotation, its third is the translation.
std::optional<rigid_transform> decompose(const Matrix3d& h) {
  auto scale = (h.col(0).norm() + h.col(1).norm()) / 2;
  if (!(scale > 0) || !std::isfinite(scale))
    return std::nullopt;
  Matrix3d axes;
  axes << h.col(0) / scale, h.col(1) / scale,
      h.col(0).cross(h.col(1)) / (scale * scale);
  Eigen::JacobiSVD<Matrix3d> svd{axes,
                                 Eigen::ComputeFullU | Eigen::ComputeFullV};
  Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (!(rotation.determinant() > 0))
    return std::nullopt;
  return rigid_transform{rotation, h.col(2) / scale};
}

/// The pose that looks the same from far away: the tag mirrored in depth along
/// the line of sight. Mirroring alone would turn the tag inside out, so its
/// normal is mirrored once more.
rigid_transform mirror_in_depth(const rigid_transform& pose) {
  Vector3d sight = pose.translation.normalized();
  Matrix3d mirror = Matrix3d::Identity() - 2 * sight * sight.transpose();
  return {mirror * pose.rotation * Vector3d{1, 1, -1}.asDiagonal(),
          pose.translation};
}

double raw_error(const tag_corners& seen, const tag_corners& expected) {
  auto sum = 0.0;
  for (auto i = 0; i < 4; ++i)
    sum += (seen[i] - expected[i]).squaredNorm();
  return std::sqrt(sum / 4);
}

/// The four corners of a tag, to be fitted to where they are without
/// distortion.
struct tag_problem {
  tag_problem(const tag_corners& corners, double tag_size_m,
              const camera_model& camera)
      : points(tag_points(tag_size_m)), fit(camera) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto straight = camera.undistort(corners[i]);
      is_finite = is_finite && straight.allFinite();
      directions[i] = camera.normalize(straight);
      fit.add(points[i], straight);
    }
  }

  /// Both minima of a flat target.
  std::vector<rigid_transform> solve() const {
    const auto h = is_finite ? homography(points, directions) : std::nullopt;
    const auto start = h ? decompose(*h) : std::nullopt;
    std::vector<rigid_transform> result;
    if (!start)
      return result;
    for (const auto& guess : {*start, mirror_in_depth(*start)}) {
      const auto found = fit.minimize(guess);
      if (fit.linearize(found).in_front)
        result.push_back(found);
    }
    return result;
  }

  std::array<Vector3d, 4> points;
  std::array<Vector2d, 4> directions;
  rigid_fit fit;
  bool is_finite = true;
};

} // namespace

std::array<Vector3d, 4> tag_points(double tag_size_m) {
  auto h = tag_size_m / 2;
  return {Vector3d{-h, -h, 0}, Vector3d{h, -h, 0}, Vector3d{h, h, 0},
          Vector3d{-h, h, 0}};
}

tag_corners project_corners(const tag_pose& pose, double tag_size_m,
                            const camera_model& camera) {
  auto points = tag_points(tag_size_m);
  tag_corners result;
  for (auto i = 0; i < 4; ++i)
    result[i] = camera.distort(
        camera.project(pose.orientation * points[i] + pose.position));
  return result;
}

std::vector<rigid_transform> pose_candidates(const tag_corners& corners,
                                             double tag_size_m,
                                             const camera_model& camera) {
  return tag_problem{corners, tag_size_m, camera}.solve();
}

std::optional<tag_pose> estimate_pose(const tag_corners& corners,
                                      double tag_size_m,
                                      const camera_model& camera) {
  const tag_problem problem{corners, tag_size_m, camera};
  std::optional<tag_pose> best;
  auto least = std::numeric_limits<double>::infinity();
  for (const auto& found : problem.solve()) {
    const auto at = problem.fit.linearize(found);
    if (!(at.cost < least))
      continue;
    least = at.cost;
    best = tag_pose{found.translation,
                    Eigen::Quaterniond{found.rotation}.normalized(), 0,
                    covariance_of(at, 4)};
  }
  if (best)
    best->reprojection_error_px =
        raw_error(corners, project_corners(*best, tag_size_m, camera));
  return best;
}

} // namespace roscell::pose
