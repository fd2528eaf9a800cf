#include "skills/pose_estimation/tag_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace roscell::pose {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using vector6d = Eigen::Matrix<double, 6, 1>;
using vector8d = Eigen::Matrix<double, 8, 1>;
using matrix6d = Eigen::Matrix<double, 6, 6>;
using matrix8d = Eigen::Matrix<double, 8, 8>;

struct rigid_transform {
  Matrix3d rotation;
  Vector3d translation;
};

/// Corner points of the tag in its own frame, in the order of tag_corners.
std::array<Vector3d, 4> tag_points(double tag_size_m) {
  auto h = tag_size_m / 2;
  return {Vector3d{-h, -h, 0}, Vector3d{h, -h, 0}, Vector3d{h, h, 0},
          Vector3d{-h, h, 0}};
}

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

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d result;
  result << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return result;
}

/// Squared reprojection error with its normal equations at one pose.
struct linearization {
  double cost = 0;
  matrix6d hessian = matrix6d::Zero();
  vector6d gradient = vector6d::Zero();
  bool in_front = true;
};

/// The fit of a rigid transform to four undistorted corners.
class pose_fit {
public:
  pose_fit(const std::array<Vector3d, 4>& points, const tag_corners& corners,
           const camera_model& camera)
      : points_(points), corners_(corners), camera_(camera) {
    // nop
  }

  /// Levenberg-Marquardt. The parameters are a small rotation, applied from
  /// the left, and a translation.
  rigid_transform minimize(rigid_transform pose) const {
    constexpr auto most_steps = 50;
    auto damping = 1e-3;
    auto here = linearize(pose);
    for (auto i = 0; i < most_steps && damping < 1e9; ++i) {
      matrix6d damped = here.hessian;
      damped.diagonal() *= 1 + damping;
      vector6d step = -damped.ldlt().solve(here.gradient);
      auto next = move(pose, step);
      auto there = linearize(next);
      if (!there.in_front || !(there.cost < here.cost)) {
        damping *= 10;
        continue;
      }
      auto gain = here.cost - there.cost;
      pose = next;
      here = there;
      damping = std::max(damping / 10, 1e-9);
      if (gain < 1e-12 * here.cost)
        break;
    }
    return pose;
  }

  linearization linearize(const rigid_transform& pose) const {
    linearization result;
    for (auto i = 0; i < 4; ++i) {
      Vector3d turned = pose.rotation * points_[i];
      Vector3d point = turned + pose.translation;
      if (!(point.z() > 0)) {
        result.in_front = false;
        return result;
      }
      Vector2d residual = camera_.project(point) - corners_[i];
      auto slope = projection_slope(point, turned);
      result.cost += residual.squaredNorm();
      result.hessian += slope.transpose() * slope;
      result.gradient += slope.transpose() * residual;
    }
    return result;
  }

private:
  using matrix26d = Eigen::Matrix<double, 2, 6>;

  static rigid_transform move(const rigid_transform& pose,
                              const vector6d& step) {
    Vector3d turn = step.head<3>();
    auto angle = turn.norm();
    Matrix3d rotation = Matrix3d::Identity();
    if (angle > 0)
      rotation = Eigen::AngleAxisd{angle, turn / angle}.toRotationMatrix();
    return {rotation * pose.rotation, pose.translation + step.tail<3>()};
  }

  /// How the pixel of `point` moves with the six parameters.
  matrix26d projection_slope(const Vector3d& point,
                             const Vector3d& turned) const {
    Eigen::Matrix<double, 2, 3> of_point;
    auto z = point.z();
    of_point << 1 / z, 0, -point.x() / (z * z), 0, 1 / z, -point.y() / (z * z);
    of_point = camera_.focal().asDiagonal() * of_point;
    matrix26d result;
    result << of_point * -cross_matrix(turned), of_point;
    return result;
  }

  const std::array<Vector3d, 4>& points_;
  const tag_corners& corners_;
  const camera_model& camera_;
};

double raw_error(const tag_corners& seen, const tag_corners& expected) {
  auto sum = 0.0;
  for (auto i = 0; i < 4; ++i)
    sum += (seen[i] - expected[i]).squaredNorm();
  return std::sqrt(sum / 4);
}

} // namespace

tag_corners project_corners(const tag_pose& pose, double tag_size_m,
                            const camera_model& camera) {
  auto points = tag_points(tag_size_m);
  tag_corners result;
  for (auto i = 0; i < 4; ++i)
    result[i] = camera.distort(
        camera.project(pose.orientation * points[i] + pose.position));
  return result;
}

std::optional<tag_pose> estimate_pose(const tag_corners& corners,
                                      double tag_size_m,
                                      const camera_model& camera) {
  auto points = tag_points(tag_size_m);
  tag_corners straight;
  std::array<Vector2d, 4> directions;
  for (auto i = 0; i < 4; ++i) {
    straight[i] = camera.undistort(corners[i]);
    directions[i] = camera.normalize(straight[i]);
  }
  auto h = homography(points, directions);
  auto start = h ? decompose(*h) : std::nullopt;
  if (!start)
    return std::nullopt;
  pose_fit fit{points, straight, camera};
  std::optional<tag_pose> best;
  auto least = std::numeric_limits<double>::infinity();
  for (const auto& guess : {*start, mirror_in_depth(*start)}) {
    auto found = fit.minimize(guess);
    auto at = fit.linearize(found);
    if (!at.in_front || !(at.cost < least))
      continue;
    least = at.cost;
    best = tag_pose{found.translation,
                    Eigen::Quaterniond{found.rotation}.normalized()};
  }
  if (best)
    best->reprojection_error_px =
        raw_error(corners, project_corners(*best, tag_size_m, camera));
  return best;
}

} // namespace roscell::pose
