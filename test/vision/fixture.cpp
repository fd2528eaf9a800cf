#include "test/vision/fixture.hpp"

#include "tools/render_scenes/picture.hpp"

#include <algorithm>

namespace roscell::test {

namespace {

std::vector<engine::stream> streams(const std::vector<std::string>& types,
                                    const std::string& prefix) {
  std::vector<engine::stream> result;
  for (const auto& type : types)
    result.push_back({"ros2", prefix + std::to_string(result.size()), type});
  return result;
}

} // namespace

engine::environment make_environment(const std::vector<std::string>& inputs,
                                     const std::vector<std::string>& outputs,
                                     const nlohmann::json& options) {
  engine::environment result;
  result.inputs = streams(inputs, "/in_");
  result.outputs = streams(outputs, "/out_");
  result.parameters = parameters_of(options);
  return result;
}

engine::frame make_frame(std::size_t port, const std::string& type,
                         std::string payload, std::string name) {
  engine::frame result;
  result.port = port;
  result.data_type = type;
  result.payload = std::move(payload);
  result.name = std::move(name);
  result.time = std::chrono::system_clock::time_point{std::chrono::seconds{7}};
  return result;
}

std::string rendered_scene::image() const {
  return ros2::serialize(vision::view(picture, {{12, 34}, "eye"}));
}

ros2::sensor_msgs::camera_info rendered_scene::info() const {
  auto f = options.focal_px;
  auto c = scenes::camera{options}.centre();
  ros2::sensor_msgs::camera_info result;
  result.width = picture.width;
  result.height = picture.height;
  result.distortion_model = "plumb_bob";
  result.d.assign(options.distortion.begin(), options.distortion.end());
  result.k = {f, 0, c.x(), 0, f, c.y(), 0, 0, 1};
  result.p = {f, 0, c.x(), 0, 0, f, c.y(), 0, 0, 0, 1, 0};
  return result;
}

const scenes::placed_tag& rendered_scene::tag(int id) const {
  return *std::find_if(tags.begin(), tags.end(),
                       [=](const auto& x) { return x.id == id; });
}

scenes::scene_options small_scene(unsigned tags, std::uint64_t seed) {
  scenes::scene_options result;
  result.tags = tags;
  result.width = 640;
  result.height = 480;
  result.focal_px = 500;
  result.farthest_m = 1.5;
  result.seed = seed;
  return result;
}

rendered_scene render(const scenes::scene_options& options) {
  scenes::tag_sheet sheet{options.family, options.tags};
  return render(options, scenes::place_tags(options, sheet.margin()));
}

rendered_scene render(const scenes::scene_options& options,
                      const std::vector<scenes::placed_tag>& tags) {
  scenes::tag_sheet sheet{options.family, options.tags};
  auto pixels =
      scenes::expose(scenes::draw_scene(options, sheet, tags), options, 0);
  rendered_scene result{options, tags, {}};
  result.picture.width = static_cast<std::uint32_t>(pixels.cols);
  result.picture.height = static_cast<std::uint32_t>(pixels.rows);
  result.picture.pixels.assign(pixels.datastart, pixels.dataend);
  return result;
}

const rendered_scene& four_tags() {
  static const auto scene = render(small_scene(4));
  return scene;
}

pose_difference difference(const ros2::geometry_msgs::transform& found,
                           const scenes::placed_tag& truth) {
  const auto& t = found.translation;
  const auto& q = found.rotation;
  auto away = (Eigen::Vector3d{t.x, t.y, t.z} - truth.position).norm();
  auto turned =
      Eigen::Quaterniond{q.w, q.x, q.y, q.z}.angularDistance(truth.orientation);
  return {100 * away / truth.position.norm(), turned * 180 / 3.14159265358979};
}

} // namespace roscell::test
