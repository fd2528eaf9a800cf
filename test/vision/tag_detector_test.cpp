#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/tag_detector.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <fstream>

using namespace roscell;
using namespace roscell::pose;
using Catch::Matchers::Contains;

namespace {

vision::gray_view view_of(const vision::picture& picture) {
  return {picture.width, picture.height, picture.width, picture.pixels.data()};
}

std::vector<int> ids_of(const std::vector<tag_detection>& tags) {
  std::vector<int> result;
  for (const auto& tag : tags)
    result.push_back(tag.id);
  return result;
}

std::vector<int> count_to(int n) {
  std::vector<int> result;
  for (auto i = 0; i < n; ++i)
    result.push_back(i);
  return result;
}

std::string error_of(const nlohmann::json& options) {
  try {
    tag_detector{detector_options::of(test::parameters_of(options))};
  } catch (const engine::start_error& e) {
    return e.what();
  }
  return "none";
}

/// "0, (x y), (x y), (x y), (x y)" per line.
std::vector<tag_corners> read_truth() {
  std::vector<tag_corners> result;
  std::ifstream file{test::photo_truth};
  for (std::string line; std::getline(file, line);) {
    tag_corners c;
    if (std::sscanf(line.c_str(),
                    "0, (%lf %lf), (%lf %lf), (%lf %lf), (%lf %lf)", &c[0].x(),
                    &c[0].y(), &c[1].x(), &c[1].y(), &c[2].x(), &c[2].y(),
                    &c[3].x(), &c[3].y())
        == 8)
      result.push_back(c);
  }
  return result;
}

double worst_corner(const tag_corners& a, const tag_corners& b) {
  auto worst = 0.0;
  for (auto i = 0; i < 4; ++i)
    worst = std::max(worst, (a[i] - b[i]).norm());
  return worst;
}

} // namespace

TEST_CASE("the twelve tags of a real photo are found where they are") {
  auto picture = vision::decode_picture(test::content_of(test::photo),
                                        vision::pixel_format::mono8);
  detector_options options;
  options.decimation = 1;
  options.refine = false;
  auto found = tag_detector{options}.detect(view_of(picture));
  auto truth = read_truth();
  CHECK(truth.size() == 12);
  CHECK(found.size() == 12);
  for (const auto& corners : truth) {
    auto least = 1e9;
    for (const auto& tag : found)
      least = std::min(least, worst_corner(tag.corners, corners));
    CHECK(least < 0.2);
  }
}

TEST_CASE("each family is found by its name, with corners within a pixel") {
  auto options = test::small_scene(4);
  options.family =
      GENERATE("tag36h11", "tag25h9", "tag16h5", "tagStandard41h12");
  CAPTURE(options.family);
  auto scene = test::render(options);
  detector_options wanted;
  wanted.family = options.family;
  tag_detector detector{wanted};
  CHECK(detector.family() == options.family);
  auto found = detector.detect(view_of(scene.picture));
  REQUIRE(ids_of(found) == count_to(4));
  for (const auto& tag : found) {
    auto truth = scenes::corners_of(scene.tag(tag.id), options.tag_size_m,
                                    scenes::camera{options});
    CHECK(worst_corner(tag.camera_corners(), truth) < 0.6);
    CHECK(tag.decision_margin > 20);
  }
}

TEST_CASE("rows may be longer than the image is wide") {
  const auto& scene = test::four_tags();
  const auto& picture = scene.picture;
  constexpr auto step = 700U;
  std::vector<std::uint8_t> padded(std::size_t{step} * picture.height, 77);
  for (auto y = 0U; y < picture.height; ++y)
    std::copy_n(&picture.pixels[y * picture.step()], picture.width,
                &padded[std::size_t{y} * step]);
  tag_detector detector{detector_options{}};
  CHECK(ids_of(detector.detect(
            {picture.width, picture.height, step, padded.data()}))
        == count_to(4));
}

TEST_CASE("detection leaves the image as it was, also when it blurs") {
  const auto& scene = test::four_tags();
  auto before = scene.picture.pixels;
  detector_options options;
  options.decimation = GENERATE(1.0F, 2.0F);
  options.blur = 0.8F;
  tag_detector detector{options};
  CHECK(detector.detect(view_of(scene.picture)).size() == 4);
  CHECK(scene.picture.pixels == before);
}

TEST_CASE("images without tags and images of hardly any size hold no tags") {
  detector_options options;
  options.decimation = GENERATE(1.0F, 2.0F, 4.0F);
  tag_detector detector{options};
  auto [width, height] =
      GENERATE(std::pair{0U, 0U}, std::pair{1U, 1U}, std::pair{3U, 500U},
               std::pair{500U, 3U}, std::pair{16U, 16U}, std::pair{33U, 70U});
  std::vector<std::uint8_t> pixels(std::size_t{width} * height, 128);
  CHECK(detector.detect({width, height, width, pixels.data()}).empty());
}

TEST_CASE("options that the library cannot serve are refused") {
  CHECK_THAT(error_of({{"family", "tag99h99"}}), Contains("tag36h11"));
  CHECK_THAT(error_of({{"family", "tagStandard52h13"}, {"max_hamming", 2}}),
             Contains("max_hamming"));
  CHECK_THAT(error_of({{"decimation", 0}}), Contains("decimation"));
  CHECK_THAT(error_of({{"threads", 1000}}), Contains("threads"));
  CHECK(error_of({{"family", "tagStandard52h13"}}) == "none");
}
