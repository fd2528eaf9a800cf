#include "tools/compare_poses/comparison.hpp"

#include <algorithm>

namespace roscell::comparison {

namespace {

/// 0 of nothing.
double median(std::vector<double> values) {
  if (values.empty())
    return 0;
  auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

pose_error median(const std::vector<pose_error>& errors) {
  std::vector<double> distances;
  std::vector<double> rotations;
  for (const auto& error : errors) {
    distances.push_back(error.distance_percent);
    rotations.push_back(error.rotation_deg);
  }
  return {median(std::move(distances)), median(std::move(rotations))};
}

} // namespace

pose_error error_of(const pose& estimate, const pose& truth) {
  constexpr auto degrees_per_radian = 180 / 3.14159265358979323846;
  return {100 * (estimate.position - truth.position).norm()
              / truth.position.norm(),
          estimate.orientation.angularDistance(truth.orientation)
              * degrees_per_radian};
}

scene_comparison compare(std::string name, const true_poses& truth,
                         const estimated_poses& estimates) {
  scene_comparison result;
  result.name = std::move(name);
  for (const auto& [id, true_pose] : truth) {
    tag_comparison tag{id, true_pose};
    if (auto found = estimates.find(id); found != estimates.end()) {
      std::vector<pose_error> errors;
      for (const auto& estimate : found->second)
        errors.push_back(error_of(estimate, true_pose));
      tag.frames = errors.size();
      tag.error = median(errors);
      tag.latest = found->second.back();
      result.errors.insert(result.errors.end(), errors.begin(), errors.end());
    }
    result.tags.push_back(tag);
  }
  for (const auto& [id, poses] : estimates)
    if (truth.count(id) == 0)
      result.strangers.push_back(id);
  return result;
}

bool summary::is_within(const pose_error& limit) const {
  return found == tags && tags > 0
         && median.distance_percent <= limit.distance_percent
         && median.rotation_deg <= limit.rotation_deg;
}

summary summarize(const std::vector<scene_comparison>& scenes) {
  summary result;
  std::vector<pose_error> errors;
  for (const auto& scene : scenes) {
    result.tags += scene.tags.size();
    for (const auto& tag : scene.tags)
      result.found += tag.frames > 0 ? 1 : 0;
    errors.insert(errors.end(), scene.errors.begin(), scene.errors.end());
  }
  result.median = median(errors);
  return result;
}

} // namespace roscell::comparison
