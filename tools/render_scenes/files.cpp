#include "tools/render_scenes/files.hpp"

#include "tools/render_scenes/picture.hpp"
#include "tools/render_scenes/scene.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace roscell::scenes {

namespace {

using nlohmann::json;

json matrix(int rows, int columns, std::vector<double> values) {
  return {{"rows", rows}, {"cols", columns}, {"data", std::move(values)}};
}

json describe_camera(const scene_options& options) {
  const auto f = options.focal_px;
  const Eigen::Vector2d c = camera{options}.centre();
  return {
      {"image_width", options.width},
      {"image_height", options.height},
      {"camera_name", "rendered"},
      {"camera_matrix", matrix(3, 3, {f, 0, c.x(), 0, f, c.y(), 0, 0, 1})},
      {"distortion_model", "plumb_bob"},
      {"distortion_coefficients",
       matrix(1, 5, {options.distortion.begin(), options.distortion.end()})},
      {"rectification_matrix", matrix(3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1})},
      {"projection_matrix",
       matrix(3, 4, {f, 0, c.x(), 0, 0, f, c.y(), 0, 0, 0, 1, 0})}};
}

json describe_tag(const placed_tag& tag, const scene_options& options) {
  const auto& p = tag.position;
  const auto& q = tag.orientation;
  auto corners = json::array();
  for (const auto& c : corners_of(tag, options.tag_size_m, camera{options}))
    corners.push_back({c.x(), c.y()});
  return {{"id", tag.id},
          {"pose",
           {{"position", {p.x(), p.y(), p.z()}},
            {"orientation", {q.x(), q.y(), q.z(), q.w()}}}},
          {"corners_px", corners}};
}

void write_json(const json& document, const std::string& path) {
  std::ofstream file{path};
  file << document.dump(2) << '\n';
  if (!file.flush())
    throw std::runtime_error("cannot write '" + path + "'");
}

std::string frame_path(const std::string& folder, unsigned frame) {
  char name[32];
  std::snprintf(name, sizeof(name), "/frame_%03u.png", frame);
  return folder + name;
}

} // namespace

void render_scene(const scene_options& options, const std::string& folder) {
  tag_sheet sheet{options.family, options.tags};
  auto tags = place_tags(options, sheet.margin());
  auto scene = draw_scene(options, sheet, tags);
  std::filesystem::create_directories(folder);
  for (auto frame = 0U; frame < options.frames; ++frame) {
    auto path = frame_path(folder, frame);
    if (!cv::imwrite(path, expose(scene, options, frame)))
      throw std::runtime_error("cannot write '" + path + "'");
  }
  write_json(describe_camera(options), folder + "/camera.json");
  auto truth = json::array();
  for (const auto& tag : tags)
    truth.push_back(describe_tag(tag, options));
  write_json({{"family", options.family},
              {"tag_size_m", options.tag_size_m},
              {"tags", truth}},
             folder + "/truth.json");
}

} // namespace roscell::scenes
