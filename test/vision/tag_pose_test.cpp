#include "skills/pose_estimation/tag_pose.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace roscell;
using namespace roscell::pose;

namespace {

constexpr auto size_m = 0.16;

camera_model bent_camera() {
  ros2::sensor_msgs::camera_info info;
  info.k = {600, 0, 320, 0, 600, 240, 0, 0, 1};
  info.distortion_model = "plumb_bob";
  info.d = {-0.25, 0.08, 0.001, -0.0005, 0};
  return std::get<camera_model>(camera_model::of(info, false));
}

/// Random poses in view, tilted up to 60 degrees.
class random_poses {
public:
  tag_pose next() {
    tag_pose result;
    result.position = {between(-0.4, 0.4), between(-0.3, 0.3), between(0.5, 3)};
    result.position.head<2>() *= result.position.z();
    Eigen::AngleAxisd facing{M_PI, Eigen::Vector3d::UnitX()};
    auto around = between(0, 2 * M_PI);
    Eigen::AngleAxisd tilt{
        between(0, M_PI / 3),
        Eigen::Vector3d{std::cos(around), std::sin(around), 0}};
    Eigen::AngleAxisd turn{between(0, 2 * M_PI), Eigen::Vector3d::UnitZ()};
    result.orientation = facing * tilt * turn;
    return result;
  }

  double between(double least, double most) {
    return std::uniform_real_distribution{least, most}(random_);
  }

private:
  std::mt19937 random_{1};
};

} // namespace

TEST_CASE("a tag that faces the camera upright has apriltag_ros's pose") {
  // Bottom left, bottom right, top right, top left; 0.16 m at 0.6 m with a
  // focal length of 600 pixels are 160 pixels.
  tag_corners corners{Eigen::Vector2d{240, 320}, Eigen::Vector2d{400, 320},
                      Eigen::Vector2d{400, 160}, Eigen::Vector2d{240, 160}};
  auto pose = estimate_pose(corners, size_m, {600, 600, 320, 240});
  REQUIRE(pose);
  CHECK(pose->position.isApprox(Eigen::Vector3d{0, 0, 0.6}, 1e-6));
  CHECK(std::abs(pose->orientation.x()) == Approx(1));
  CHECK(pose->reprojection_error_px < 1e-6);
}

TEST_CASE("the pose behind exact corners is found, with and without "
          "distortion") {
  auto camera = GENERATE(camera_model{600, 610, 320, 240}, bent_camera());
  random_poses poses;
  for (auto i = 0; i < 500; ++i) {
    auto truth = poses.next();
    auto found =
        estimate_pose(project_corners(truth, size_m, camera), size_m, camera);
    REQUIRE(found);
    CHECK((found->position - truth.position).norm() < 1e-5);
    CHECK(found->orientation.angularDistance(truth.orientation) < 1e-4);
    CHECK(found->reprojection_error_px < 1e-5);
  }
}

TEST_CASE("no other pose near the one that is found explains noisy corners "
          "better") {
  camera_model camera{600, 600, 320, 240};
  random_poses poses;
  auto error = [&](const tag_pose& pose, const tag_corners& seen) {
    auto sum = 0.0;
    auto expected = project_corners(pose, size_m, camera);
    for (auto k = 0; k < 4; ++k)
      sum += (seen[k] - expected[k]).squaredNorm();
    return std::sqrt(sum / 4);
  };
  for (auto i = 0; i < 100; ++i) {
    auto truth = poses.next();
    auto seen = project_corners(truth, size_m, camera);
    for (auto& corner : seen)
      corner +=
          Eigen::Vector2d{poses.between(-0.5, 0.5), poses.between(-0.5, 0.5)};
    auto found = estimate_pose(seen, size_m, camera);
    REQUIRE(found);
    CHECK(found->reprojection_error_px == Approx(error(*found, seen)));
    CHECK(found->reprojection_error_px <= error(truth, seen));
    for (auto axis = 0; axis < 3; ++axis)
      for (auto sign : {-1, 1}) {
        auto moved = *found;
        moved.position[axis] += sign * 1e-4;
        CHECK(error(moved, seen) >= found->reprojection_error_px);
        auto turned = *found;
        turned.orientation =
            Eigen::AngleAxisd{sign * 1e-3, Eigen::Vector3d::Unit(axis)}
            * found->orientation;
        CHECK(error(turned, seen) >= found->reprojection_error_px);
      }
  }
}

TEST_CASE("corners on a line have no pose") {
  tag_corners corners{Eigen::Vector2d{0, 0}, Eigen::Vector2d{1, 1},
                      Eigen::Vector2d{2, 2}, Eigen::Vector2d{3, 3}};
  CHECK_FALSE(estimate_pose(corners, size_m, {600, 600, 320, 240}));
  corners.fill(Eigen::Vector2d{5, 5});
  CHECK_FALSE(estimate_pose(corners, size_m, {600, 600, 320, 240}));
}
