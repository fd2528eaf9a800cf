#include "skills/pose_estimation/bundle_pose.hpp"
#include "skills/pose_estimation/tag_pose.hpp"
#include "tools/bench/vision_modes.hpp"
#include "tools/render_scenes/picture.hpp"
#include "tools/render_scenes/scene.hpp"

#include <nlohmann/json.hpp>

#include <iostream>
#include <optional>
#include <random>
#include <vector>

namespace roscell::bench {

namespace {

constexpr auto size_m = 0.1;
constexpr auto apart_m = 0.3; ///< From middle to middle of two tags.

pose::bundle board() {
  pose::bundle result{"board", {}};
  for (auto id = 0; id < 4; ++id) {
    const auto row = id / 2;
    result.tags.push_back(
        {id,
         size_m,
         {Eigen::Matrix3d::Identity(),
          {(id % 2 - 0.5) * apart_m, (row - 0.5) * apart_m, 0}}});
  }
  return result;
}

/// The board in view, tilted up to 45 degrees.
pose::rigid_transform random_pose(std::mt19937& random) {
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution{least, most}(random);
  };
  const auto z = between(1, 2.5);
  const auto around = between(0, 2 * M_PI);
  const Eigen::AngleAxisd facing{M_PI, Eigen::Vector3d::UnitX()};
  const Eigen::AngleAxisd tilt{
      between(0, M_PI / 4),
      Eigen::Vector3d{std::cos(around), std::sin(around), 0}};
  const Eigen::AngleAxisd turn{between(0, 2 * M_PI), Eigen::Vector3d::UnitZ()};
  return {(facing * tilt * turn).toRotationMatrix(),
          {between(-0.15, 0.15) * z, between(-0.1, 0.1) * z, z}};
}

struct error_sums {
  std::vector<double> distance_mm;
  std::vector<double> turn_deg;

  void add(const pose::rigid_transform& found,
           const pose::rigid_transform& truth) {
    distance_mm.push_back(1000
                          * (found.translation - truth.translation).norm());
    turn_deg.push_back(Eigen::Quaterniond{found.rotation}.angularDistance(
                           Eigen::Quaterniond{truth.rotation})
                       * 180 / M_PI);
  }
};

double mean(const std::vector<double>& values) {
  auto sum = 0.0;
  for (auto x : values)
    sum += x;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

class bundle_comparison {
public:
  explicit bundle_comparison(const std::string& family) : sheet_(family, 4) {
    options_.family = family;
    options_.tag_size_m = size_m;
    options_.width = 640;
    options_.height = 480;
    options_.focal_px = 600;
    pose::detector_options how;
    how.family = family;
    how.decimation = 1;
    detector_.emplace(how);
  }

  void look(const pose::rigid_transform& truth, unsigned round) {
    std::vector<scenes::placed_tag> tags;
    for (const auto& tag : body_.tags) {
      const auto at = truth * tag.place;
      tags.push_back({tag.id, at.translation, Eigen::Quaterniond{at.rotation}});
    }
    const auto picture = scenes::expose(
        scenes::draw_scene(options_, sheet_, tags), options_, round);
    const auto seen = detector_->detect(
        {static_cast<std::uint32_t>(picture.cols),
         static_cast<std::uint32_t>(picture.rows),
         static_cast<std::uint32_t>(picture.step), picture.data});
    const scenes::camera lens{options_};
    const pose::camera_model eye{options_.focal_px, options_.focal_px,
                                 lens.centre().x(), lens.centre().y()};
    const auto sight = pose::locate(body_, seen, eye);
    if (seen.size() != 4 || !sight.where)
      return;
    body.add(sight.where->pose, truth);
    for (const auto& tag : seen)
      if (const auto alone =
              pose::estimate_pose(tag.camera_corners(), size_m, eye)) {
        const auto& place = body_.tags[static_cast<std::size_t>(tag.id)].place;
        single.add({alone->orientation.toRotationMatrix(), alone->position},
                   truth * place);
      }
  }

  error_sums body;
  error_sums single;

private:
  const pose::bundle body_ = board();
  scenes::scene_options options_;
  scenes::tag_sheet sheet_;
  std::optional<pose::tag_detector> detector_;
};

void print_errors(const bundle_comparison& x, const std::string& family) {
  std::cout << nlohmann::json{{"bench", "bundle_of_four"},
                              {"family", family},
                              {"poses", x.body.distance_mm.size()},
                              {"bundle_mean_mm", mean(x.body.distance_mm)},
                              {"single_mean_mm", mean(x.single.distance_mm)},
                              {"bundle_median_mm",
                               quantile(x.body.distance_mm, 0.5)},
                              {"single_median_mm",
                               quantile(x.single.distance_mm, 0.5)},
                              {"bundle_mean_deg", mean(x.body.turn_deg)},
                              {"single_mean_deg", mean(x.single.turn_deg)},
                              {"ratio_mm", mean(x.body.distance_mm)
                                               / mean(x.single.distance_mm)},
                              {"ratio_deg",
                               mean(x.body.turn_deg) / mean(x.single.turn_deg)}}
            << std::endl;
}

void compare_family(const std::string& family, const bundle_options& options) {
  bundle_comparison result{family};
  std::mt19937 random{options.seed};
  for (auto i = 0U; i < options.poses; ++i)
    result.look(random_pose(random), i);
  print_errors(result, family);
}

} // namespace

void compare_errors_of_bundles(const bundle_options& options) {
  for (const auto& family : options.families)
    compare_family(family, options);
}

} // namespace roscell::bench
