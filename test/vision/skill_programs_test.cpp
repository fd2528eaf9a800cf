#include "test/places.hpp"
#include "test/skills/child_process.hpp"
#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdlib>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

const std::string skills = test::build_dir() / "skills/";

json stream(const std::string& endpoint, const std::string& type) {
  return {{"protocol", "file"}, {"endpoint", endpoint}, {"data_type", type}};
}

/// The domain is no other test's.
child_process::variables environment(const std::string& model,
                                     const json& inputs, const json& outputs,
                                     const json& options) {
  child_process::variables result{{"ROSCELL_MODEL", model},
                                  {"ROS_DOMAIN_ID", "93"},
                                  {"ROSCELL_INPUTS", inputs.dump()},
                                  {"ROSCELL_OUTPUTS", outputs.dump()},
                                  {"ROSCELL_PARAMETERS", options.dump()}};
  for (const char* name : {"ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const auto* value = std::getenv(name))
      result[name] = value;
  return result;
}

/// A folder `in` with one picture of four tags and its camera's description.
void write_scene(const temp_folder& folder) {
  const auto& scene = four_tags();
  auto c = scenes::camera{scene.options}.centre();
  std::filesystem::create_directory(folder / "in");
  folder.write("in/a.png", vision::encode_png(scene.picture));
  folder.write("in/camera.json",
               json{{"image_width", 640},
                    {"image_height", 480},
                    {"camera_matrix",
                     {{"data", {500, 0, c.x(), 0, 500, c.y(), 0, 0, 1}}}}}
                   .dump());
}

void check_line(const std::string& text) {
  auto line = json::parse(text);
  REQUIRE(line["tags"].size() == 4);
  for (const auto& tag : line["tags"]) {
    auto p = tag["pose"]["position"].get<std::array<double, 3>>();
    auto q = tag["pose"]["orientation"].get<std::array<double, 4>>();
    auto off = difference({{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}},
                          four_tags().tag(tag["id"]));
    CHECK(off.distance_percent < 1);
    CHECK(off.rotation_deg < 2);
  }
}

/// The last whole line of a file that is being written.
std::string last_line(const std::string& path) {
  auto text = content_of(path);
  auto end = text.rfind('\n');
  if (end == std::string::npos)
    return "";
  auto begin = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  begin = begin == std::string::npos ? 0 : begin + 1;
  return text.substr(begin, end - begin);
}

json topic(const std::string& name, const std::string& type) {
  return {{"protocol", "ros2"}, {"endpoint", name}, {"data_type", type}};
}

json descriptor_of(const std::string& name) {
  return json::parse(content_of(skills + name + "/skill.json"));
}

} // namespace

TEST_CASE("pose_estimation turns a folder of images into lines and pictures") {
  temp_folder folder;
  write_scene(folder);
  folder.write("in/b.png", "broken");
  folder.write("in/notes.txt", "no image");
  child_process skill{
      {skills + "pose_estimation/bin/pose_estimation"},
      environment("apriltag3",
                  json::array({stream(folder / "in", picture_type)}),
                  json::array({stream(folder / "poses.jsonl", lines_type),
                               stream(folder / "pictures/", picture_type)}),
                  {{"follow", false}, {"tag_size_m", 0.16}})};
  CHECK(skill.wait() == 0);
  CHECK_THAT(skill.output(), Contains("pose_estimation: skipped 'b.png'")
                                 && !Contains("notes.txt"));
  CHECK(names_in(folder / "pictures") == std::vector<std::string>{"a.png"});
  check_line(content_of(folder / "poses.jsonl"));
}

TEST_CASE("images go from a folder over ROS 2 topics to poses") {
  temp_folder folder;
  write_scene(folder);
  std::filesystem::create_directory(folder / "out");
  auto images = topic("/scene/image", image_type);
  auto infos = topic("/scene/camera_info", info_type);
  auto poses = folder / "out/poses.jsonl";
  child_process estimator{
      {skills + "pose_estimation/bin/pose_estimation"},
      environment("apriltag3", json::array({images, infos}),
                  json::array({stream(poses, lines_type),
                               topic("/tf", transforms_type)}),
                  {{"tag_size_m", 0.16}})};
  child_process camera{
      {skills + "image_source/bin/image_source"},
      environment("folder", json::array({stream(folder / "in", picture_type)}),
                  json::array({images, infos}),
                  {{"rate_hz", 10}, {"loop", true}})};
  REQUIRE(wait_in_folder(folder / "out", [&] {
    return last_line(poses).find("position") != std::string::npos;
  }));
  check_line(last_line(poses));
  camera.signal(SIGTERM);
  auto camera_code = camera.wait();
  CAPTURE(camera.output());
  CHECK(camera_code == 0);
  estimator.signal(SIGTERM);
  auto code = estimator.wait();
  CAPTURE(estimator.output());
  CHECK(code == 0);
}

TEST_CASE("a step that pose_estimation cannot do ends with one clear line") {
  temp_folder folder;
  child_process skill{
      {skills + "pose_estimation/bin/pose_estimation"},
      environment("apriltag3", json::array({stream(folder / "", picture_type)}),
                  json::array({stream(folder / "out", "text/plain")}),
                  json::object())};
  CHECK(skill.wait() == 2);
  CHECK_THAT(skill.output(), Contains("text/plain"));
}

TEST_CASE("each skill folder is complete and says what its program can do") {
  auto name = GENERATE("image_source", "video_source", "pose_estimation",
                       "pose_estimation_video", "rectify", "convert");
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
