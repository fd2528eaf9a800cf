#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/vision/image_codec.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;
using pose::pose_estimator;
using strings = std::vector<std::string>;

namespace {

const json tag_size{{"tag_size_m", 0.16}};

/// An executor with what it emits and says.
struct bench {
  bench(const strings& inputs, const strings& outputs, const json& options)
      : estimator(make_environment(inputs, outputs, options), said.function()) {
    // nop
  }

  void see(std::size_t port, const rendered_scene& scene) {
    estimator.process(make_frame(port, image_type, scene.image()), out);
  }

  void calibrate(std::size_t port, const ros2::sensor_msgs::camera_info& info) {
    estimator.process(make_frame(port, info_type, ros2::serialize(info)), out);
  }

  ros2::tf2_msgs::tf_message transforms(std::size_t port) {
    return ros2::deserialize<ros2::tf2_msgs::tf_message>(
        out.of(port).back().payload);
  }

  said_lines said;
  collecting_emitter out;
  pose_estimator estimator;
};

void check_poses(const ros2::tf2_msgs::tf_message& message,
                 const rendered_scene& scene) {
  REQUIRE(message.transforms.size() == scene.tags.size());
  for (std::size_t i = 0; i < message.transforms.size(); ++i) {
    const auto& found = message.transforms[i];
    CHECK(found.child_frame_id == "tag36h11:" + std::to_string(i));
    auto off = difference(found.transform, scene.tag(static_cast<int>(i)));
    CHECK(off.distance_percent < 1);
    CHECK(off.rotation_deg < 2);
  }
}

std::string error_of(const strings& inputs, const strings& outputs,
                     const json& options = json::object()) {
  try {
    bench{inputs, outputs, options};
  } catch (const engine::start_error& e) {
    return e.what();
  }
  return "none";
}

} // namespace

TEST_CASE("poses are those that the scene was rendered from") {
  auto options = small_scene(6);
  SECTION("without distortion") {
    options.distortion = {};
  }
  SECTION("with distortion") {
    options.distortion = {-0.25, 0.08, 0.001, -0.0005, 0};
  }
  auto scene = render(options);
  bench b{{image_type, info_type}, {transforms_type}, tag_size};
  b.calibrate(1, scene.info());
  b.see(0, scene);
  auto message = b.transforms(0);
  check_poses(message, scene);
  CHECK(message.transforms[0].header.frame_id == "eye");
  CHECK(message.transforms[0].header.stamp
        == ros2::builtin_interfaces::time{12, 34});
  CHECK(b.said.lines().empty());
}

TEST_CASE("poses of compressed images are those of the images") {
  const auto& scene = four_tags();
  auto format = GENERATE("jpeg", "png");
  vision::compression how{parameters_of({{"compressed_format", format}})};
  auto message = how.compress(vision::view(scene.picture, {{12, 34}, "eye"}));
  bench b{{compressed_type, info_type}, {transforms_type}, tag_size};
  b.calibrate(1, scene.info());
  b.estimator.process(make_frame(0, compressed_type, ros2::serialize(message)),
                      b.out);
  check_poses(b.transforms(0), scene);
  CHECK(b.transforms(0).transforms[0].header
        == ros2::std_msgs::header{{12, 34}, "eye"});
}

TEST_CASE("a compressed image that is broken fails, with its reason") {
  bench b{{compressed_type}, {lines_type}, tag_size};
  ros2::sensor_msgs::compressed_image broken{{}, "jpeg", {1, 2, 3}};
  auto frame = make_frame(0, compressed_type, ros2::serialize(broken));
  CHECK_THROWS_WITH(b.estimator.process(frame, b.out),
                    Contains("neither PNG nor JPEG"));
  CHECK(b.out.of(0).empty());
}

TEST_CASE("the detection array is filled in as apriltag_ros does") {
  const auto& scene = four_tags();
  bench b{{image_type, info_type}, {detections_type}, tag_size};
  b.calibrate(1, scene.info());
  b.see(0, scene);
  auto message =
      ros2::deserialize<ros2::apriltag_msgs::april_tag_detection_array>(
          b.out.of(0).back().payload);
  CHECK(message.header.frame_id == "eye");
  REQUIRE(message.detections.size() == 4);
  const auto& tag = message.detections[2];
  CHECK(tag.family == "tag36h11");
  CHECK(tag.id == 2);
  CHECK(tag.hamming == 0);
  CHECK(tag.decision_margin > 20);
  // The homography takes the middle of the tag to its centre.
  CHECK(tag.homography[2] / tag.homography[8] == Approx(tag.centre.x));
  CHECK(tag.homography[5] / tag.homography[8] == Approx(tag.centre.y));
  auto truth =
      scenes::corners_of(scene.tag(2), 0.16, scenes::camera{scene.options});
  for (auto i = 0; i < 4; ++i) {
    CHECK(tag.corners[i].x == Approx(truth[i].x() + 0.5).margin(0.6));
    CHECK(tag.corners[i].y == Approx(truth[i].y() + 0.5).margin(0.6));
  }
}

TEST_CASE("a line of JSON tells all about an image") {
  const auto& scene = four_tags();
  bench b{{image_type, info_type}, {lines_type}, tag_size};
  b.calibrate(1, scene.info());
  b.see(0, scene);
  auto line = b.out.of(0).back().payload;
  CHECK(line.find('\n') == std::string::npos);
  auto document = json::parse(line);
  CHECK(document["frame"] == "frame");
  CHECK(document["source"] == 0);
  CHECK(document["stamp"] == Approx(12.000000034));
  CHECK(document["width"] == 640);
  CHECK(document["processing_ms"] > 0);
  // The image is stamped 12 s after 1970.
  CHECK(document["age_ms"] > 1.7e12);
  REQUIRE(document["tags"].size() == 4);
  const auto& tag = document["tags"][3];
  CHECK(tag["id"] == 3);
  CHECK(tag["corners_px"].size() == 4);
  CHECK(tag["pose"]["position"].size() == 3);
  CHECK(tag["pose"]["orientation"].size() == 4);
  CHECK(tag["pose"]["reprojection_error_px"] < 0.5);
}

TEST_CASE("an annotated picture shows the image with the tags marked") {
  const auto& scene = four_tags();
  bench b{{image_type, info_type}, {picture_type}, tag_size};
  b.calibrate(1, scene.info());
  b.see(0, scene);
  const auto& frame = b.out.of(0).back();
  CHECK(frame.name == "in_0.png");
  auto picture =
      vision::decode_picture(frame.payload, vision::pixel_format::bgr8);
  CHECK(picture.width == 640);
  auto pixel = [&](const Eigen::Vector2d& at) {
    auto x = static_cast<std::size_t>(std::lround(at.x()));
    auto y = static_cast<std::size_t>(std::lround(at.y()));
    const auto* p = &picture.pixels[y * picture.step() + 3 * x];
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  auto truth =
      scenes::corners_of(scene.tag(0), 0.16, scenes::camera{scene.options});
  auto bottom = pixel((truth[0] + truth[1]) / 2);
  auto top = pixel((truth[2] + truth[3]) / 2);
  CHECK((bottom[0] > 150 && bottom[1] < 100 && bottom[2] > 150));
  CHECK((top[0] < 100 && top[1] > 150 && top[2] > 150));
}

TEST_CASE("pictures of a topic come at their rate and replace each other") {
  const auto& scene = four_tags();
  bench slow{{image_type}, {picture_type}, {{"picture_rate_hz", 0.001}}};
  bench all{{image_type}, {picture_type}, {{"picture_rate_hz", 0}}};
  bench files{{picture_type}, {picture_type}, {{"picture_rate_hz", 0.001}}};
  for (auto i = 0; i < 3; ++i) {
    slow.see(0, scene);
    all.see(0, scene);
    files.estimator.process(make_frame(0, picture_type,
                                       vision::encode_png(scene.picture),
                                       "photo.jpeg"),
                            files.out);
  }
  CHECK(slow.out.of(0).size() == 1);
  REQUIRE(all.out.of(0).size() == 3);
  CHECK(all.out.of(0)[0].name == "frame.png");
  REQUIRE(files.out.of(0).size() == 3);
  CHECK(files.out.of(0)[0].name == "photo.png");
}

TEST_CASE("several scenes in one instance keep to their own outputs") {
  const auto& first = four_tags();
  auto options = small_scene(6, 2);
  options.focal_px = 420;
  auto second = render(options);
  bench b{{image_type, image_type, info_type, info_type},
          {transforms_type, transforms_type, lines_type},
          tag_size};
  b.calibrate(3, second.info());
  b.calibrate(2, first.info());
  b.see(1, second);
  b.see(0, first);
  check_poses(b.transforms(0), first);
  check_poses(b.transforms(1), second);
  // The only output of a type is shared.
  REQUIRE(b.out.of(2).size() == 2);
  CHECK(json::parse(b.out.of(2)[0].payload)["source"] == 1);
  CHECK(json::parse(b.out.of(2)[1].payload)["source"] == 0);
}

TEST_CASE("missing CameraInfo is said once, and once that it came") {
  const auto& scene = four_tags();
  bench b{
      {image_type, info_type}, {transforms_type, detections_type}, tag_size};
  for (auto i = 0; i < 4; ++i)
    b.see(0, scene);
  // A few images may overtake the first CameraInfo.
  CHECK(b.said.lines().empty());
  for (auto i = 0; i < 3; ++i)
    b.see(0, scene);
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("/in_0") && Contains("no CameraInfo")
                                    && Contains("'fx'"));
  CHECK(b.transforms(0).transforms.empty());
  CHECK(ros2::deserialize<ros2::apriltag_msgs::april_tag_detection_array>(
            b.out.of(1).back().payload)
            .detections.size()
        == 4);
  b.calibrate(1, scene.info());
  b.see(0, scene);
  b.see(0, scene);
  REQUIRE(b.said.lines().size() == 2);
  CHECK_THAT(b.said.lines()[1], Contains("good now"));
  CHECK(b.transforms(0).transforms.size() == 4);
}

TEST_CASE("bad CameraInfo is said once each time it changes") {
  const auto& scene = four_tags();
  bench b{{image_type, info_type}, {transforms_type}, tag_size};
  auto see_with = [&](const ros2::sensor_msgs::camera_info& info) {
    for (auto i = 0; i < 3; ++i) {
      b.calibrate(1, info);
      b.see(0, scene);
    }
    return b.transforms(0).transforms.size();
  };
  auto zero = scene.info();
  zero.k = {};
  zero.p = {};
  auto other_size = scene.info();
  other_size.width = 1280;
  CHECK(see_with(zero) == 0);
  CHECK(see_with(scene.info()) == 4);
  CHECK(see_with(other_size) == 0);
  CHECK(see_with(scene.info()) == 4);
  REQUIRE(b.said.lines().size() == 5);
  CHECK_THAT(b.said.lines()[0], Contains("all zero") && Contains("calibrate"));
  CHECK_THAT(b.said.lines()[1], Contains("good now"));
  CHECK_THAT(b.said.lines()[2], Contains("changes while it runs"));
  CHECK_THAT(b.said.lines()[3],
             Contains("1280 x 480") && Contains("640 x 480"));
  CHECK_THAT(b.said.lines()[4], Contains("good now"));
}

TEST_CASE("intrinsics from parameters go before CameraInfo") {
  const auto& scene = four_tags();
  auto k = scene.info().k;
  json options{{"tag_size_m", 0.16},
               {"fx", k[0]},
               {"fy", k[4]},
               {"cx", k[2]},
               {"cy", k[5]}};
  bench b{{image_type, info_type}, {transforms_type}, options};
  b.calibrate(1, {});
  b.see(0, scene);
  check_poses(b.transforms(0), scene);
  CHECK(b.said.lines().empty());
}

TEST_CASE("without any intrinsics the first image says so") {
  const auto& scene = four_tags();
  bench b{{image_type}, {transforms_type}, tag_size};
  b.see(0, scene);
  b.see(0, scene);
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("not known") && Contains("'fx'"));
}

TEST_CASE("a broken image file is said once and skipped") {
  const auto& scene = four_tags();
  bench b{{picture_type}, {lines_type}, tag_size};
  auto good = vision::encode_png(scene.picture);
  auto see = [&](const std::string& content, const std::string& name) {
    b.estimator.process(make_frame(0, picture_type, content, name), b.out);
  };
  see("no picture", "broken.png");
  see(good, "good.png");
  see("no picture", "broken.png");
  CHECK(b.out.of(0).size() == 1);
  CHECK(json::parse(b.out.of(0)[0].payload)["stamp"] == Approx(7));
  REQUIRE(b.said.lines().size() == 2);
  CHECK_THAT(b.said.lines()[0], Contains("'broken.png'"));
}

TEST_CASE("an image message whose sizes lie fails and changes nothing") {
  const auto& scene = four_tags();
  bench b{{image_type}, {lines_type}, tag_size};
  auto message = scene.image();
  auto see = [&](const std::string& payload) {
    b.estimator.process(make_frame(0, image_type, payload), b.out);
  };
  CHECK_THROWS(see(message.substr(0, message.size() - 1000)));
  CHECK_THROWS(see(""));
  CHECK(b.out.of(0).empty());
  see(message);
  CHECK(b.out.of(0).size() == 1);
}

TEST_CASE("a step that makes no sense does not start") {
  CHECK_THAT(error_of({"text/plain"}, {lines_type}), Contains("text/plain"));
  CHECK_THAT(error_of({image_type}, {"text/plain"}), Contains("text/plain"));
  CHECK_THAT(error_of({info_type}, {lines_type}), Contains("0 image"));
  CHECK_THAT(error_of({image_type, info_type, info_type}, {lines_type}),
             Contains("2 CameraInfo"));
  CHECK_THAT(
      error_of({image_type, image_type, image_type}, {lines_type, lines_type}),
      Contains("2 outputs"));
  CHECK_THAT(error_of({image_type}, {lines_type}, {{"tag_size_m", 0}}),
             Contains("tag_size_m"));
  CHECK(error_of({image_type}, {}) == "none");
}
