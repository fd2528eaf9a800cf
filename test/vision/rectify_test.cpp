#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/rectify/rectifier.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <random>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using rectify::rectifier;
using ros2::sensor_msgs::camera_info;
using strings = std::vector<std::string>;

namespace {

const std::vector<double> bent{-0.28, 0.09, 0.001, -0.0008, 0.01};

/// A camera whose rectified images are a little wider than its raw ones.
camera_info camera_with(const std::string& model, std::vector<double> d) {
  camera_info info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = model;
  info.d = std::move(d);
  info.k = {500, 0, 325, 0, 510, 236, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {450, 0, 318, 0, 0, 455, 241, 0, 0, 0, 1, 0};
  return info;
}

rectify::pixel_map map_of(const camera_info& info) {
  return rectify::make_map(info,
                           std::get<vision::lens>(vision::lens::of(info)));
}

/// Calls `check(u, v, place)` for pixels all over the image.
template <class Check>
void all_over(const rectify::pixel_map& map, Check check) {
  REQUIRE(map.places.size() == std::size_t{map.width} * map.height);
  for (std::uint32_t v = 0; v < map.height; v += 53)
    for (std::uint32_t u = 0; u < map.width; u += 71)
      check(u, v, map.places[std::size_t{v} * map.width + u]);
}

/// The pixel at which a raw image of `info` shows direction (x, y), as the
/// documentation of CameraInfo and OpenCV write it.
std::pair<double, double> seen_at(const camera_info& info, double x, double y) {
  auto d = info.d;
  d.resize(8);
  auto r2 = x * x + y * y;
  double bent_x = 0;
  double bent_y = 0;
  if (info.distortion_model == "equidistant") {
    auto r = std::sqrt(r2);
    auto t = std::atan(r);
    auto td = t
              * (1 + d[0] * std::pow(t, 2) + d[1] * std::pow(t, 4)
                 + d[2] * std::pow(t, 6) + d[3] * std::pow(t, 8));
    bent_x = x * td / r;
    bent_y = y * td / r;
  } else {
    auto radial = (1 + d[0] * r2 + d[1] * r2 * r2 + d[4] * r2 * r2 * r2)
                  / (1 + d[5] * r2 + d[6] * r2 * r2 + d[7] * r2 * r2 * r2);
    bent_x = x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x);
    bent_y = y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y;
  }
  return {info.k[0] * bent_x + info.k[2], info.k[4] * bent_y + info.k[5]};
}

bool is_inside(const camera_info& info, std::pair<double, double> at) {
  return at.first > -1 && at.second > -1 && at.first < info.width
         && at.second < info.height;
}

void check_place(const rectify::place& at, std::pair<double, double> truth) {
  CHECK(std::abs(at.x - truth.first) < 1e-3);
  CHECK(std::abs(at.y - truth.second) < 1e-3);
}

struct bench {
  explicit bench(const strings& inputs = {image_type, info_type},
                 const strings& outputs = {image_type, info_type})
      : skill(make_environment(inputs, outputs, nlohmann::json::object()),
              said.function()) {
    // nop
  }

  void see(const std::string& image) {
    skill.process(make_frame(0, image_type, image), out);
  }

  void calibrate(const camera_info& info) {
    skill.process(make_frame(1, info_type, ros2::serialize(info)), out);
  }

  said_lines said;
  collecting_emitter out;
  rectifier skill;
};

/// An image of 640 x 480 pixels of noise.
std::string noise(const std::string& encoding, std::uint32_t pixel_bytes,
                  std::uint32_t gap = 0) {
  std::mt19937 random{7};
  auto step = 640 * pixel_bytes + gap;
  std::vector<std::uint8_t> bytes(std::size_t{step} * 480);
  for (auto& x : bytes)
    x = static_cast<std::uint8_t>(random());
  return ros2::serialize(ros2::image_view{{{12, 34}, "eye"},
                                          480,
                                          640,
                                          encoding,
                                          0,
                                          step,
                                          bytes.data(),
                                          bytes.size()});
}

cv::Mat to_matrix(const ros2::image_view& image, int type) {
  return {static_cast<int>(image.height), static_cast<int>(image.width), type,
          const_cast<std::uint8_t*>(image.data), image.step};
}

/// What goes wrong with a camera, in its only line.
std::string problem_with(const camera_info& info) {
  bench b;
  b.calibrate(info);
  for (auto i = 0; i < 3; ++i)
    b.see(noise("mono8", 1));
  CHECK(b.out.of(0).empty());
  CHECK(b.out.of(1).empty());
  CHECK(b.said.lines().size() == 1);
  return b.said.lines().empty() ? "none" : b.said.lines()[0];
}

} // namespace

TEST_CASE("the map is where the lens puts each rectified pixel") {
  auto info =
      GENERATE(camera_with("plumb_bob", bent),
               camera_with("plumb_bob", {0.1, -0.05, 0.002, 0}),
               camera_with("rational_polynomial",
                           {0.5, 0.1, 1e-4, 2e-4, 0.01, 0.8, 0.2, 0.03}),
               camera_with("equidistant", {0.05, -0.01, 0.004, -0.001}));
  CAPTURE(info.distortion_model);
  all_over(map_of(info), [&](auto u, auto v, const auto& at) {
    auto truth =
        seen_at(info, (u - info.p[2]) / info.p[0], (v - info.p[6]) / info.p[5]);
    if (is_inside(info, truth))
      check_place(at, truth);
  });
}

TEST_CASE("R turns the rectified camera against the raw one") {
  auto info = camera_with("plumb_bob", bent);
  const auto angle = 0.05;
  info.r = {std::cos(angle), 0, -std::sin(angle), 0, 1, 0,
            std::sin(angle), 0, std::cos(angle)};
  all_over(map_of(info), [&](auto u, auto v, const auto& at) {
    // Back from the rectified camera: the transpose of R.
    auto x = (u - info.p[2]) / info.p[0];
    auto y = (v - info.p[6]) / info.p[5];
    auto depth = -std::sin(angle) * x + std::cos(angle);
    auto truth = seen_at(info, (std::cos(angle) * x + std::sin(angle)) / depth,
                         y / depth);
    if (is_inside(info, truth))
      check_place(at, truth);
  });
}

TEST_CASE("a zero R turns nothing") {
  auto info = camera_with("plumb_bob", bent);
  auto turned = map_of(info);
  info.r = {};
  auto zero = map_of(info);
  all_over(zero, [&](auto u, auto v, const auto& at) {
    check_place(at,
                {turned.places[v * 640 + u].x, turned.places[v * 640 + u].y});
  });
}

TEST_CASE("pixels are as OpenCV's remap has them") {
  auto [encoding, type, bytes] = GENERATE(
      std::tuple{"mono8", CV_8UC1, 1U}, std::tuple{"rgb8", CV_8UC3, 3U},
      std::tuple{"bgra8", CV_8UC4, 4U}, std::tuple{"mono16", CV_16UC1, 2U});
  CAPTURE(encoding);
  auto info = camera_with("plumb_bob", bent);
  auto map = map_of(info);
  // OpenCV rounds places to 1/32 pixel: give it such, outside ones too.
  for (auto& at : map.places)
    at = {std::round(at.x * 32) / 32, std::round(at.y * 32) / 32};
  auto payload = noise(encoding, bytes, 16);
  auto raw = ros2::view_image(payload);
  auto pixels = rectify::remap(raw, map);
  cv::Mat places(480, 640, CV_32FC2, map.places.data());
  cv::Mat expected;
  cv::remap(to_matrix(raw, type), expected, places, cv::Mat{}, cv::INTER_LINEAR,
            cv::BORDER_CONSTANT);
  cv::Mat found(480, 640, type, pixels.data());
  // It also rounds weights, so that a few pixels in a hundred differ by one.
  CHECK(cv::norm(found, expected, cv::NORM_INF) <= 1);
  auto numbers = static_cast<double>(found.total()) * found.channels();
  CHECK(cv::norm(found, expected, cv::NORM_L1) / numbers < 0.05);
}

TEST_CASE("a rectified image comes with the camera's description") {
  bench b;
  auto info = camera_with("plumb_bob", bent);
  info.header = {{1, 2}, "other"};
  b.calibrate(info);
  b.see(noise("rgb8", 3, 16));
  REQUIRE(b.out.of(0).size() == 1);
  REQUIRE(b.out.of(1).size() == 1);
  auto image = ros2::view_image(b.out.of(0)[0].payload);
  CHECK(image.header == ros2::std_msgs::header{{12, 34}, "eye"});
  CHECK(image.encoding == "rgb8");
  CHECK(image.width == 640);
  CHECK(image.height == 480);
  CHECK(image.step == 1920);
  auto sent = ros2::deserialize<camera_info>(b.out.of(1)[0].payload);
  info.header = image.header;
  CHECK(sent == info);
  CHECK(b.said.lines().empty());
}

TEST_CASE("an image without distortion is passed on as it is") {
  bench b;
  b.calibrate(camera_with("", {0, 0, 0, 0, 0}));
  // Not even the encoding matters then.
  auto message = noise("bayer_rggb8", 1);
  b.see(message);
  REQUIRE(b.out.of(0).size() == 1);
  CHECK(b.out.of(0)[0].payload == message);
}

TEST_CASE("part of a picture, coarser, is rectified as part of the whole") {
  auto whole = camera_with("plumb_bob", bent);
  auto part = whole;
  part.roi = {200, 100, 300, 400, false};
  part.binning_x = 2;
  part.binning_y = 2;
  auto all = map_of(whole);
  auto some = map_of(vision::describe_sent_images(part));
  CHECK(some.width == 200);
  CHECK(some.height == 150);
  all_over(some, [&](auto u, auto v, const auto& at) {
    const auto& in_whole = all.places[(v * 2 + 100) * 640 + u * 2 + 200];
    // What lies outside of the part is black, wherever it is.
    if (at.x > -1 && at.y > -1 && at.x < 200 && at.y < 150)
      check_place(at, {(in_whole.x - 200) / 2, (in_whole.y - 100) / 2});
  });
}

TEST_CASE("a camera that gives nothing to rectify by is said once") {
  CHECK_THAT(problem_with({}), Contains("without pixels"));
  auto info = camera_with("plumb_bob", bent);
  info.k = {};
  CHECK_THAT(problem_with(info), Contains("is not calibrated"));
  info = camera_with("plumb_bob", bent);
  info.p = {};
  CHECK_THAT(problem_with(info), Contains("focal lengths in P"));
  info = camera_with("plumb_bob", bent);
  info.r = {1, 0, 0, 1, 0, 0, 1, 0, 0};
  CHECK_THAT(problem_with(info), Contains("cannot be inverted"));
  CHECK_THAT(problem_with(camera_with("thin_prism", bent)),
             Contains("thin_prism"));
  info = camera_with("plumb_bob", bent);
  info.width = 320;
  CHECK_THAT(problem_with(info),
             Contains("320 x 480") && Contains("640 x 480"));
}

TEST_CASE("of each image that is left out the reason is given") {
  bench b;
  auto message = noise("mono8", 1);
  for (auto i = 0; i < 6; ++i)
    b.see(message);
  REQUIRE(b.out.excuses().size() == 6);
  // It may yet come.
  CHECK(b.out.excuses()[0].empty());
  CHECK_THAT(b.out.excuses()[5], Contains("no CameraInfo has come"));
  b.calibrate(camera_with("plumb_bob", bent));
  b.see(message);
  CHECK(b.out.excuses().size() == 6);
}

TEST_CASE("images follow when the calibration has come or was fixed") {
  bench b;
  auto message = noise("mono8", 1);
  for (auto i = 0; i < 10; ++i)
    b.see(message);
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("no CameraInfo has come"));
  b.calibrate(camera_with("plumb_bob", bent));
  b.see(message);
  CHECK(b.out.of(0).size() == 1);
  REQUIRE(b.said.lines().size() == 2);
  CHECK_THAT(b.said.lines()[1], Contains("good now"));
  // Another calibration makes another image.
  b.calibrate(camera_with("plumb_bob", {0.1}));
  b.see(message);
  CHECK(b.out.of(0)[1].payload != b.out.of(0)[0].payload);
}

TEST_CASE("a raw image in an unknown encoding ends the skill") {
  bench b;
  b.calibrate(camera_with("plumb_bob", bent));
  CHECK_THROWS_AS(b.see(noise("h264", 1)), engine::unusable_input);
  CHECK_THROWS_WITH(b.see(noise("h264", 1)), Contains("'h264'"));
}

TEST_CASE("poses of a rectified image are those of one without distortion") {
  auto options = small_scene(6);
  auto straight = render(options);
  options.distortion = {-0.25, 0.08, 0.001, -0.0005, 0};
  auto distorted = render(options, straight.tags);
  bench b;
  b.calibrate(distorted.info());
  b.see(distorted.image());
  REQUIRE(b.out.of(0).size() == 1);
  auto poses_of = [&](const std::string& image) {
    said_lines said;
    collecting_emitter out;
    pose::pose_estimator estimator{
        make_environment({image_type, info_type}, {transforms_type},
                         {{"tag_size_m", 0.16}, {"rectified", true}}),
        said.function()};
    auto info = ros2::serialize(straight.info());
    estimator.process(make_frame(1, info_type, info), out);
    estimator.process(make_frame(0, image_type, image), out);
    return ros2::deserialize<ros2::tf2_msgs::tf_message>(
        out.of(0).at(0).payload);
  };
  auto from_rectified = poses_of(b.out.of(0)[0].payload);
  REQUIRE(from_rectified.transforms.size() == 6);
  auto from_straight = poses_of(straight.image());
  REQUIRE(from_straight.transforms.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    // What the noise of two pictures makes of one pose.
    auto truth = straight.tag(static_cast<int>(i));
    auto a = difference(from_rectified.transforms[i].transform, truth);
    CHECK(a.distance_percent < 0.2);
    CHECK(a.rotation_deg < 0.5);
    const auto& t = from_straight.transforms[i].transform.translation;
    const auto& q = from_straight.transforms[i].transform.rotation;
    truth.position = Eigen::Vector3d{t.x, t.y, t.z};
    truth.orientation = Eigen::Quaterniond{q.w, q.x, q.y, q.z};
    auto between = difference(from_rectified.transforms[i].transform, truth);
    CHECK(between.distance_percent < 0.2);
    CHECK(between.rotation_deg < 0.5);
  }
}

TEST_CASE("each camera to be rectified has a description") {
  auto error_of = [](const strings& inputs, const strings& outputs) {
    try {
      bench{inputs, outputs};
    } catch (const engine::start_error& e) {
      return std::string{e.what()};
    }
    return std::string{"none"};
  };
  CHECK_THAT(error_of({image_type}, {image_type}), Contains("0 CameraInfo"));
  CHECK_THAT(error_of({info_type}, {image_type}), Contains("0 image"));
  CHECK_THAT(error_of({image_type, info_type, "text/plain"}, {image_type}),
             Contains("text/plain"));
  CHECK_THAT(error_of({image_type, info_type}, {"image/png"}),
             Contains("image/png"));
  CHECK(error_of({image_type, info_type}, {image_type}) == "none");
}
