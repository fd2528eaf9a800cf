#include "test/skills/child_process.hpp"
#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

const std::string skills = ROSCELL_BINARY_DIR "/skills/";

json stream(const std::string& endpoint, const std::string& type) {
  return {{"protocol", "file"}, {"endpoint", endpoint}, {"data_type", type}};
}

child_process::variables environment(const json& inputs, const json& outputs,
                                     const json& options) {
  return {{"ROSCELL_MODEL", "apriltag3"},
          {"ROSCELL_INPUTS", inputs.dump()},
          {"ROSCELL_OUTPUTS", outputs.dump()},
          {"ROSCELL_PARAMETERS", options.dump()}};
}

json descriptor_of(const std::string& name) {
  return json::parse(content_of(skills + name + "/skill.json"));
}

} // namespace

TEST_CASE("pose_estimation turns a folder of images into lines and pictures") {
  temp_folder folder;
  const auto& scene = four_tags();
  std::filesystem::create_directory(folder / "in");
  folder.write("in/a.png", vision::encode_png(scene.picture));
  folder.write("in/b.png", "broken");
  folder.write("in/notes.txt", "no image");
  auto c = scenes::camera{scene.options}.centre();
  folder.write("in/camera.json",
               json{{"image_width", 640},
                    {"image_height", 480},
                    {"camera_matrix",
                     {{"data", {500, 0, c.x(), 0, 500, c.y(), 0, 0, 1}}}}}
                   .dump());
  child_process skill{
      {skills + "pose_estimation/bin/pose_estimation"},
      environment(json::array({stream(folder / "in", picture_type)}),
                  json::array({stream(folder / "poses.jsonl", lines_type),
                               stream(folder / "pictures/", picture_type)}),
                  {{"follow", false}, {"tag_size_m", 0.16}})};
  CHECK(skill.wait() == 0);
  CHECK_THAT(skill.output(), Contains("pose_estimation: skipped 'b.png'")
                                 && !Contains("notes.txt"));
  CHECK(names_in(folder / "pictures") == std::vector<std::string>{"a.png"});
  auto line = json::parse(content_of(folder / "poses.jsonl"));
  REQUIRE(line["tags"].size() == 4);
  for (const auto& tag : line["tags"]) {
    auto p = tag["pose"]["position"].get<std::array<double, 3>>();
    auto q = tag["pose"]["orientation"].get<std::array<double, 4>>();
    auto off = difference({{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}},
                          scene.tag(tag["id"]));
    CHECK(off.distance_percent < 1);
    CHECK(off.rotation_deg < 2);
  }
}

TEST_CASE("a step that pose_estimation cannot do ends with one clear line") {
  temp_folder folder;
  child_process skill{
      {skills + "pose_estimation/bin/pose_estimation"},
      environment(json::array({stream(folder / "", picture_type)}),
                  json::array({stream(folder / "out", "text/plain")}),
                  json::object())};
  CHECK(skill.wait() == 2);
  CHECK_THAT(skill.output(), Contains("text/plain"));
}

TEST_CASE("each skill folder is complete and says what its program can do") {
  auto name = GENERATE("image_source", "video_source", "pose_estimation",
                       "pose_estimation_video");
  CAPTURE(name);
  auto descriptor = descriptor_of(name);
  auto program =
      skills + name + "/" + descriptor["entry_point"][0].get<std::string>();
  child_process help{{program, "--help"}, {}};
  CHECK(help.wait() == 0);
  for (const auto& model : descriptor["models"])
    CHECK_THAT(help.output(), Contains(model["name"].get<std::string>()));
  for (const auto& protocol : descriptor["input"]["protocols"])
    CHECK_THAT(help.output(), Contains(protocol.get<std::string>()));
}
