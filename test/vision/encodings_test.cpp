#include "test/vision/encodings.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/convert/converter.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/rectify/rectifier.hpp"
#include "skills/vision/brightness.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;
using bytes = std::vector<std::uint8_t>;

namespace {

/// Soft shapes, of an odd size where `odd`.
vision::picture soft_picture(bool odd) {
  vision::picture result;
  result.width = odd ? 163 : 160;
  result.height = odd ? 121 : 120;
  for (auto y = 0U; y < result.height; ++y)
    for (auto x = 0U; x < result.width; ++x)
      result.pixels.push_back(static_cast<std::uint8_t>(
          128 + 100 * std::sin(x / 9.0) * std::cos(y / 11.0)));
  return result;
}

/// How much two pictures are alike, whatever their contrast: 1 at most.
double likeness(const bytes& a, const bytes& b) {
  REQUIRE(a.size() == b.size());
  const auto n = static_cast<double>(a.size());
  double sum_a = 0;
  double sum_b = 0;
  double aa = 0;
  double bb = 0;
  double ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  return (ab - sum_a * sum_b / n)
         / std::sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
}

bytes gray_of(const std::string& message) {
  const auto image = ros2::view_image(message);
  bytes buffer;
  const auto gray = vision::to_gray(image, buffer);
  bytes result;
  for (auto y = 0U; y < gray.height; ++y)
    result.insert(result.end(), gray.data + std::size_t{y} * gray.step,
                  gray.data + std::size_t{y} * gray.step + gray.width);
  return result;
}

template <class Executor>
struct bench {
  bench(const std::vector<std::string>& inputs, const std::string& output,
        const json& options = json::object())
      : skill(make_environment(inputs, {output}, options)) {
    // nop
  }

  std::string see(const std::string& image) {
    skill.process(make_frame(0, image_type, image), out);
    return out.of(0).empty() ? "" : out.of(0).back().payload;
  }

  collecting_emitter out;
  Executor skill;
};

/// Ways in which a camera may send an encoding.
std::vector<sent_image_form> forms_of(const std::string& encoding) {
  return {{encoding, false, 0}, {encoding, true, 6}};
}

} // namespace

TEST_CASE("tags are found in images of every encoding, byte order and padding",
          "[encodings]") {
  const auto& scene = four_tags();
  for (const auto& use : all_encodings())
    for (const auto& form : forms_of(use.name)) {
      CAPTURE(use.name, form.big_endian);
      bench<pose::pose_estimator> b{
          {image_type, info_type}, lines_type, {{"tag_size_m", 0.16}}};
      b.skill.process(make_frame(1, info_type, ros2::serialize(scene.info())),
                      b.out);
      const auto image = sent_as(form, scene.picture);
      if (!use.has_brightness) {
        CHECK_THROWS_AS(b.see(image), engine::unusable_input);
        CHECK_THROWS_WITH(b.see(image), Contains(use.name)
                                            && Contains("have the camera "
                                                        "send"));
        continue;
      }
      const auto line = json::parse(b.see(image));
      CHECK(line["tags"].size() == 4);
      for (const auto& tag : line["tags"]) {
        const auto p = tag["pose"]["position"].get<std::array<double, 3>>();
        const auto q = tag["pose"]["orientation"].get<std::array<double, 4>>();
        const auto off =
            difference({{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}},
                       scene.tag(tag["id"]));
        CHECK(off.distance_percent < 1);
        CHECK(off.rotation_deg < 2);
      }
    }
}

TEST_CASE("images of every encoding are rectified", "[encodings]") {
  const auto odd = GENERATE(false, true);
  const auto picture = soft_picture(odd);
  ros2::sensor_msgs::camera_info info;
  info.width = picture.width;
  info.height = picture.height;
  info.distortion_model = "plumb_bob";
  info.d = {-0.2, 0.05, 0, 0, 0};
  info.k = {150, 0, 80, 0, 150, 60, 0, 0, 1};
  info.p = {150, 0, 80, 0, 0, 150, 60, 0, 0, 0, 1, 0};
  bytes truth;
  for (const auto& use : all_encodings())
    for (const auto& form : forms_of(use.name)) {
      CAPTURE(use.name, form.big_endian, odd);
      bench<rectify::rectifier> b{{image_type, info_type}, image_type};
      b.skill.process(make_frame(1, info_type, ros2::serialize(info)), b.out);
      const auto result = b.see(sent_as({"mono8"}, picture));
      truth = gray_of(result);
      const auto message = b.see(sent_as(form, picture));
      const auto image = ros2::view_image(message);
      CHECK(image.encoding == use.rectified);
      CHECK(image.width == picture.width);
      CHECK(image.height == picture.height);
      if (use.has_brightness)
        CHECK(likeness(gray_of(message), truth) > 0.99);
    }
}

TEST_CASE("images of every encoding are converted", "[encodings]") {
  const auto odd = GENERATE(false, true);
  const auto target = GENERATE("mono8", "rgb8", "bgr8");
  const auto picture = soft_picture(odd);
  for (const auto& use : all_encodings())
    for (const auto& form : forms_of(use.name)) {
      CAPTURE(use.name, form.big_endian, target, odd);
      bench<convert::converter> b{
          {image_type}, image_type, {{"encoding", target}}};
      const auto image = sent_as(form, picture);
      if (!use.has_brightness) {
        CHECK_THROWS_AS(b.see(image), engine::unusable_input);
        continue;
      }
      const auto message = b.see(image);
      const auto result = ros2::view_image(message);
      CHECK(result.encoding == target);
      CHECK(result.header.frame_id == "eye");
      CHECK(likeness(gray_of(message), picture.pixels) > 0.99);
    }
}

TEST_CASE("the table of encodings names every one", "[encodings]") {
  const auto text = content_of(source_dir() / "skills/README.md");
  for (const auto& use : all_encodings())
    CHECK_THAT(text, Contains("`" + std::string{use.name} + "`"));
}

TEST_CASE("descriptors name the encodings that their skills take",
          "[encodings]") {
  const auto* name =
      GENERATE("pose_estimation", "pose_estimation_video", "convert");
  const auto descriptor =
      json::parse(content_of(source_dir() / "skills" / name / "skill.json"));
  const auto& declared =
      descriptor["models"][0]["parameters"]["encodings"]["default"];
  for (const auto& use : all_encodings()) {
    CAPTURE(name, use.name);
    const auto is_declared =
        std::find(declared.begin(), declared.end(), use.name) != declared.end();
    CHECK(is_declared == use.has_brightness);
  }
}

TEST_CASE("a step may take fewer encodings", "[encodings]") {
  const auto picture = soft_picture(false);
  bench<pose::pose_estimator> b{
      {image_type}, lines_type, {{"encodings", {"mono8", "nv12"}}}};
  CHECK(!b.see(sent_as({"nv12"}, picture)).empty());
  CHECK(!b.see(sent_as({"NV12"}, picture)).empty());
  CHECK_THROWS_WITH(b.see(sent_as({"rgb8"}, picture)),
                    Contains("'rgb8'") && Contains("'encodings'"));
}

TEST_CASE("a camera may change its encoding and size while it runs",
          "[encodings]") {
  const auto& scene = four_tags();
  bench<pose::pose_estimator> b{
      {image_type}, lines_type, {{"tag_size_m", 0.16}}};
  for (const auto* encoding : {"mono8", "nv12", "bayer_gbrg16", "uyvy"}) {
    CHECK(json::parse(b.see(sent_as({encoding}, scene.picture)))["tags"].size()
          == 4);
    CHECK(json::parse(b.see(sent_as({encoding}, soft_picture(true))))["width"]
          == 163);
  }
}

TEST_CASE("images of no, of one and of a row of 30000 pixels are images",
          "[encodings]") {
  for (const auto& use : all_encodings()) {
    if (!use.has_brightness)
      continue;
    const std::vector<std::pair<unsigned, unsigned>> sizes{
        {0, 0}, {1, 1}, {2, 1}, {1, 2}, {30'000, 1}};
    for (const auto& size : sizes) {
      const auto [width, height] = size;
      CAPTURE(use.name, size.first, size.second);
      vision::picture picture;
      picture.width = width;
      picture.height = height;
      picture.pixels.assign(std::size_t{width} * height, 90);
      const auto message = sent_as({use.name}, picture);
      CHECK(gray_of(message).size() == picture.pixels.size());
      CHECK(vision::to_bgr(ros2::view_image(message)).size()
            == 3 * picture.pixels.size());
    }
  }
}

TEST_CASE("an image that AprilTag cannot count is refused", "[encodings]") {
  pose::tag_detector detector{{}};
  bytes row(40'000 * 20);
  CHECK_THROWS_WITH(detector.detect({40'000, 20, 40'000, row.data()}),
                    Contains("40000 x 20") && Contains("too large"));
  CHECK(detector.detect({30'000, 20, 30'000, row.data()}).empty());
}
