#include "skills/pose_estimation/camera_model.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::pose;
using Catch::Matchers::Contains;

namespace {

ros2::sensor_msgs::camera_info raw_camera() {
  ros2::sensor_msgs::camera_info info;
  info.k = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.p = {400, 0, 300, 0, 0, 410, 200, 0, 0, 0, 1, 0};
  return info;
}

std::string problem_of(const ros2::sensor_msgs::camera_info& info,
                       bool rectified = false) {
  auto result = camera_model::of(info, rectified);
  auto* problem = std::get_if<std::string>(&result);
  return problem != nullptr ? *problem : "none";
}

camera_model model_of(const ros2::sensor_msgs::camera_info& info,
                      bool rectified = false) {
  return std::get<camera_model>(camera_model::of(info, rectified));
}

} // namespace

TEST_CASE("a raw image has the intrinsics K, a rectified one P") {
  auto raw = model_of(raw_camera());
  auto rectified = model_of(raw_camera(), true);
  CHECK(raw.project({0.1, 0.2, 1}).isApprox(Eigen::Vector2d{370, 342}));
  CHECK(rectified.project({0.1, 0.2, 1}).isApprox(Eigen::Vector2d{340, 282}));
}

TEST_CASE("undistorting undoes distorting all over the image") {
  auto info = raw_camera();
  auto [model, coefficients] =
      GENERATE(std::pair{"plumb_bob",
                         std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0.01}},
               std::pair{"plumb_bob", std::vector<double>{0.1, -0.05, 0, 0}},
               std::pair{"rational_polynomial",
                         std::vector<double>{0.5, 0.1, 1e-4, 2e-4, 0.01, 0.8,
                                             0.2, 0.03}});
  info.distortion_model = model;
  info.d = coefficients;
  auto camera = model_of(info);
  for (auto x = 0; x <= 640; x += 80)
    for (auto y = 0; y <= 480; y += 80) {
      Eigen::Vector2d pixel(x, y);
      CAPTURE(x, y);
      CHECK((camera.distort(camera.undistort(pixel)) - pixel).norm() < 1e-6);
    }
}

TEST_CASE("distortion follows the equations of OpenCV") {
  auto info = raw_camera();
  info.distortion_model = "plumb_bob";
  info.d = {0.1, 0, 0.01, 0.02, 0};
  // Direction (0.2, 0.1): r2 = 0.05, radial 1.005, tangential
  // 2 p1 xy + p2 (r2 + 2 x2) = 0.003 and p1 (r2 + 2 y2) + 2 p2 xy = 0.0015.
  auto seen = model_of(info).distort({320 + 500 * 0.2, 240 + 510 * 0.1});
  CHECK(seen.x() == Approx(320 + 500 * 0.204));
  CHECK(seen.y() == Approx(240 + 510 * 0.102));
}

TEST_CASE("CameraInfo that gives no model is explained with its remedy") {
  CHECK_THAT(problem_of({}), Contains("all zero") && Contains("calibrate"));
  auto info = raw_camera();
  info.k[0] = 0;
  CHECK_THAT(problem_of(info), Contains("focal lengths in K"));
  CHECK(problem_of(info, true) == "none");
  info = raw_camera();
  info.p[5] = -1;
  CHECK_THAT(problem_of(info, true), Contains("focal lengths in P"));
  info = raw_camera();
  info.d = {0.1, 0.1, 0.1, 0.1};
  info.distortion_model = "equidistant";
  CHECK(problem_of(info) == "none");
  CHECK(problem_of(info, true) == "none");
  info.distortion_model = "plumb_bob";
  info.d = {1, 2, 3, 4, 5, 6};
  CHECK_THAT(problem_of(info), Contains("6 distortion coefficients"));
  info.d = {std::numeric_limits<double>::quiet_NaN()};
  CHECK_THAT(problem_of(info), Contains("no number"));
  // Zero distortion needs no model.
  info.d = {0, 0, 0, 0};
  info.distortion_model = "";
  CHECK(problem_of(info) == "none");
}

TEST_CASE("binning and region of interest are part of the description") {
  auto info = raw_camera();
  info.width = 640;
  info.height = 480;
  CHECK(vision::describe_sent_images(info) == info);
  // The right half, of which each pixel is four of the sensor.
  info.roi.x_offset = 320;
  info.roi.y_offset = 0;
  info.roi.width = 320;
  info.roi.height = 480;
  info.binning_x = 2;
  info.binning_y = 2;
  auto sent = vision::describe_sent_images(info);
  CHECK(sent.width == 160);
  CHECK(sent.height == 240);
  for (auto rectified : {false, true}) {
    auto whole = model_of(raw_camera(), rectified);
    auto part = model_of(sent, rectified);
    Eigen::Vector3d point{0.1, 0.2, 1};
    auto pixel = whole.project(point);
    CHECK(part.project(point).isApprox(
        Eigen::Vector2d{(pixel.x() - 320) / 2, pixel.y() / 2}));
  }
}
