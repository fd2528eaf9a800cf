#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/pose_estimation/tag_detector.hpp"
#include "tools/render_scenes/picture.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

std::string readme() {
  return content_of(source_dir() / "skills/README.md");
}

/// "5 of 9" cells.
std::string cells_of(const std::string& family) {
  const scenes::tag_sheet sheet{family, 1};
  return std::to_string(sheet.border_cells()) + " of "
         + std::to_string(sheet.sheet_cells());
}

} // namespace

TEST_CASE("the tag size means of every family what the README says of it",
          "[families]") {
  for (const auto& family : scenes::family_names()) {
    CAPTURE(family);
    auto options = small_scene(2);
    options.family = family;
    const auto scene = render(options);
    pose::pose_estimator skill{
        make_environment({image_type, info_type}, {transforms_type},
                         {{"tag_size_m", 0.16}, {"family", family}})};
    collecting_emitter out;
    skill.process(make_frame(1, info_type, ros2::serialize(scene.info())), out);
    skill.process(make_frame(0, image_type, scene.image()), out);
    const auto found =
        ros2::deserialize<ros2::tf2_msgs::tf_message>(out.of(0).back().payload);
    REQUIRE(found.transforms.size() == 2);
    for (auto id = 0; id < 2; ++id) {
      const auto& transform = found.transforms[static_cast<std::size_t>(id)];
      CHECK(transform.child_frame_id == family + ":" + std::to_string(id));
      const auto off = difference(transform.transform, scene.tag(id));
      CHECK(off.distance_percent < 1);
      CHECK(off.rotation_deg < 2);
    }
    CHECK_THAT(readme(),
               Contains("| `" + family + "` | " + cells_of(family) + " |"));
  }
}

TEST_CASE("descriptors know every family of the library", "[families]") {
  const auto* name = GENERATE("pose_estimation", "pose_estimation_video");
  const auto descriptor =
      json::parse(content_of(source_dir() / "skills" / name / "skill.json"));
  auto declared = descriptor["models"][0]["parameters"]["family"]["values"]
                      .get<std::vector<std::string>>();
  auto known = scenes::family_names();
  std::sort(declared.begin(), declared.end());
  std::sort(known.begin(), known.end());
  CHECK(declared == known);
}
