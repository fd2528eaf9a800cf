#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::scenes;

namespace {

scene_options options_of(unsigned tags) {
  scene_options result;
  result.tags = tags;
  return result;
}

double tilt_deg(const placed_tag& tag) {
  auto normal = tag.orientation * Eigen::Vector3d::UnitZ();
  return std::acos(-normal.dot(tag.position.normalized())) * 180 / M_PI;
}

} // namespace

TEST_CASE("all tags of a scene are in view, within its bounds") {
  auto options = options_of(GENERATE(4U, 8U, 24U, 48U));
  auto tags = place_tags(options, 0.125);
  REQUIRE(tags.size() == options.tags);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const auto& tag = tags[i];
    CHECK(tag.id == static_cast<int>(i));
    CHECK(tag.position.norm() >= options.nearest_m);
    CHECK(tag.position.norm() <= options.farthest_m);
    CHECK(tilt_deg(tag) <= options.most_tilt_deg + 1e-6);
    for (const auto& corner : corners_of(tag, 0.2, camera{options})) {
      CHECK((corner.x() > 0 && corner.x() < options.width - 1));
      CHECK((corner.y() > 0 && corner.y() < options.height - 1));
    }
  }
}

TEST_CASE("the same seed gives the same scene, another one another") {
  auto options = options_of(8);
  auto first = place_tags(options, 0.125);
  CHECK(place_tags(options, 0.125)[7].position == first[7].position);
  options.seed = 2;
  CHECK(place_tags(options, 0.125)[7].position != first[7].position);
}

TEST_CASE("too many tags are refused") {
  auto options = test::small_scene(500);
  CHECK_THROWS_WITH(place_tags(options, 0.125),
                    Catch::Matchers::Contains("do not fit"));
}

TEST_CASE("a pixel's ray leads back to the pixel, with distortion too") {
  auto options = options_of(4);
  options.distortion = {-0.25, 0.08, 0.001, -0.0005, 0};
  camera eye{options};
  for (auto x = 0; x < 1280; x += 160) {
    Eigen::Vector2d pixel(x, 200);
    CHECK((eye.pixel_of(eye.ray_of(pixel) * 2) - pixel).norm() < 0.01);
  }
}
