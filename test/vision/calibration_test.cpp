#include "roscell/skill/errors.hpp"
#include "skills/vision/calibration.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::vision;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::temp_folder;

namespace {

/// As cameracalibrator of ROS writes it.
const std::string ros_yaml = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [500.5, 0., 320.25, 0., 501.5, 240.75, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.08, 0.001, -0.0005, 0.]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1., 0., 0., 0., 1., 0., 0., 0., 1.]
projection_matrix:
  rows: 3
  cols: 4
  data: [480., 0., 319., 0., 0., 481., 239., 0., 0., 0., 1., 0.]
)";

std::string error_in(const std::string& content) {
  temp_folder folder{"camera.yaml", content};
  try {
    read_calibration(folder / "camera.yaml");
  } catch (const engine::start_error& e) {
    return e.what();
  }
  return "none";
}

std::string error_of(const json& options) {
  try {
    calibration_of(test::parameters_of(options));
  } catch (const engine::start_error& e) {
    return e.what();
  }
  return "none";
}

std::string replaced(const std::string& part, const std::string& by) {
  auto result = ros_yaml;
  return result.replace(result.find(part), part.size(), by);
}

} // namespace

TEST_CASE("a calibration is read as ROS writes it") {
  temp_folder folder{"camera.yaml", ros_yaml};
  auto info = read_calibration(folder / "camera.yaml");
  CHECK(info.width == 640);
  CHECK(info.height == 480);
  CHECK(info.distortion_model == "plumb_bob");
  CHECK(info.k[0] == 500.5);
  CHECK(info.k[5] == 240.75);
  CHECK(info.d == std::vector<double>{-0.25, 0.08, 0.001, -0.0005, 0});
  CHECK(info.p[6] == 239);
}

TEST_CASE("a broken calibration is an error that names file and field") {
  CHECK_THAT(error_in("{"), Contains("camera.yaml"));
  CHECK_THAT(error_in("hello"), Contains("is no calibration"));
  CHECK_THAT(error_in(""), Contains("is no calibration"));
  CHECK_THAT(error_in("camera_name: x\n"), Contains("image_width"));
  CHECK_THAT(error_in(replaced("501.5", "soft")), Contains("camera_matrix"));
  CHECK_THAT(error_in(replaced("501.5", ".nan")), Contains("finite"));
  CHECK_THAT(error_in(replaced("320.25, 0., ", "")), Contains("9 numbers"));
  CHECK_THAT(error_in(std::string(70000, ' ')), Contains("larger than"));
  CHECK_THAT(error_in(std::string(10000, '[')), Contains("camera.yaml"));
  CHECK_THROWS_AS(read_calibration("/nowhere/camera.yaml"),
                  engine::start_error);
}

TEST_CASE("intrinsics may be parameters, all four or none") {
  CHECK_FALSE(calibration_of(engine::parameters{}));
  auto info =
      calibration_of(test::parameters_of({{"fx", 500},
                                          {"fy", 501},
                                          {"cx", 320},
                                          {"cy", 240},
                                          {"distortion", {-0.1, 0.02}}}));
  REQUIRE(info);
  CHECK(info->k == std::array<double, 9>{500, 0, 320, 0, 501, 240, 0, 0, 1});
  CHECK(info->d == std::vector<double>{-0.1, 0.02});
  CHECK(info->distortion_model == "plumb_bob");
  CHECK(info->width == 0);
  CHECK_THAT(error_of({{"fx", 500}}), Contains("belong together"));
  CHECK_THAT(error_of({{"fx", 0}, {"fy", 1}, {"cx", 1}, {"cy", 1}}),
             Contains("fx"));
  CHECK_THAT(
      error_of(
          {{"fx", 1}, {"fy", 1}, {"cx", 1}, {"cy", 1}, {"distortion", "none"}}),
      Contains("distortion"));
}

TEST_CASE("a calibration beside the images is found") {
  temp_folder folder;
  engine::stream images{"file", folder / "", "image/png"};
  CHECK_FALSE(calibration_beside(images, engine::parameters{}));
  folder.write("left.yaml", ros_yaml);
  CHECK_FALSE(calibration_beside(images, engine::parameters{}));
  CHECK(calibration_beside(
      images, test::parameters_of({{"camera_file", "left.yaml"}})));
  folder.write("camera.json", R"({"image_width": 8, "image_height": 6,
    "camera_matrix": {"data": [5, 0, 4, 0, 5, 3, 0, 0, 1]}})");
  auto info = calibration_beside(images, engine::parameters{});
  REQUIRE(info);
  CHECK(info->width == 8);
  CHECK(info->p[0] == 5);
  engine::stream topic{"ros2", "/image", "sensor_msgs/msg/Image"};
  CHECK_FALSE(calibration_beside(topic, engine::parameters{}));
  CHECK(calibration_beside(
      topic, test::parameters_of({{"camera_file", folder / "left.yaml"}})));
  CHECK_THROWS_AS(
      calibration_beside(images,
                         test::parameters_of({{"camera_file", "right.yaml"}})),
      engine::start_error);
}
