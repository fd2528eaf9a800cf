#include "tools/compare_poses/comparison.hpp"

#include <algorithm>
#include <numeric>

namespace roscell::comparison {

namespace {

/// One figure of each error.
template <class Summary>
std::vector<double> all(const std::vector<pose_error>& errors,
                        Summary summary) {
  std::vector<double> result;
  result.reserve(errors.size());
  for (const auto& error : errors)
    result.push_back(error.*summary);
  return result;
}

/// 0 of nothing.
double mean(const std::vector<double>& values) {
  if (values.empty())
    return 0;
  return std::accumulate(values.begin(), values.end(), 0.0)
         / static_cast<double>(values.size());
}

/// `combine` of the figures one by one.
template <class Combine>
pose_error combined(const std::vector<pose_error>& errors, Combine combine) {
  return {combine(all(errors, &pose_error::distance_percent)),
          combine(all(errors, &pose_error::rotation_deg)),
          combine(all(errors, &pose_error::distance_mm))};
}

} // namespace

double median(std::vector<double> values) {
  if (values.empty())
    return 0;
  auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

pose_error error_of(const pose& estimate, const pose& truth) {
  constexpr auto degrees_per_radian = 180 / 3.14159265358979323846;
  const auto off_m = (estimate.position - truth.position).norm();
  return {100 * off_m / truth.position.norm(),
          estimate.orientation.angularDistance(truth.orientation)
              * degrees_per_radian,
          1000 * off_m};
}

scene_comparison compare(std::string name, const true_poses& truth,
                         const estimates& estimated) {
  scene_comparison result;
  result.name = std::move(name);
  result.timing = estimated.timing;
  for (const auto& [id, true_pose] : truth) {
    tag_comparison tag{id, true_pose};
    if (auto found = estimated.poses.find(id); found != estimated.poses.end()) {
      std::vector<pose_error> errors;
      for (const auto& estimate : found->second)
        errors.push_back(error_of(estimate, true_pose));
      tag.frames = errors.size();
      tag.error = combined(errors, median);
      tag.latest = found->second.back();
      result.errors.insert(result.errors.end(), errors.begin(), errors.end());
    }
    result.tags.push_back(tag);
  }
  for (const auto& [id, poses] : estimated.poses)
    if (truth.count(id) == 0)
      result.unknown_tags.push_back(id);
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
  result.median = combined(errors, median);
  result.mean = combined(errors, mean);
  return result;
}

} // namespace roscell::comparison
