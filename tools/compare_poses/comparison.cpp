#include "tools/compare_poses/comparison.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <fstream>
#include <numeric>
#include <stdexcept>

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

namespace {

using nlohmann::json;

struct numbered_line {
  std::size_t number;
  std::string text;
};

std::ifstream open_file(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file)
    throw std::runtime_error("cannot read '" + path + "'");
  return file;
}

pose to_pose(const json& document) {
  auto p = document.at("position").get<std::array<double, 3>>();
  auto q = document.at("orientation").get<std::array<double, 4>>();
  return {{p[0], p[1], p[2]},
          Eigen::Quaterniond{q[3], q[0], q[1], q[2]}.normalized()};
}

std::deque<numbered_line> last_lines(const std::string& path,
                                     std::size_t most) {
  auto file = open_file(path);
  std::deque<numbered_line> lines;
  std::string text;
  for (std::size_t number = 1; std::getline(file, text) && !file.eof();
       ++number) {
    lines.push_back({number, text});
    if (most > 0 && lines.size() > most)
      lines.pop_front();
  }
  return lines;
}

/// What frames tell of their times.
struct frame_times {
  std::vector<double> stamps_s;
  std::vector<double> ages_ms;
};

void add_frame(const json& frame, estimated_poses& poses, frame_times& times) {
  for (const auto& tag : frame.at("tags"))
    if (const auto& found = tag.at("pose"); !found.is_null())
      poses[tag.at("id").get<int>()].push_back(to_pose(found));
  if (frame.contains("stamp"))
    times.stamps_s.push_back(frame["stamp"].get<double>());
  if (frame.contains("age_ms"))
    times.ages_ms.push_back(frame["age_ms"].get<double>());
}

frame_timing timing_of(const frame_times& times) {
  frame_timing result;
  const auto& stamps = times.stamps_s;
  if (stamps.size() > 1 && stamps.back() > stamps.front())
    result.rate_hz = static_cast<double>(stamps.size() - 1)
                     / (stamps.back() - stamps.front());
  if (!times.ages_ms.empty())
    result.latency_ms = median(times.ages_ms);
  return result;
}

} // namespace

true_poses read_truth(const std::string& path) {
  auto file = open_file(path);
  true_poses result;
  try {
    const auto document = json::parse(file);
    for (const auto& tag : document.at("tags"))
      result.emplace(tag.at("id").get<int>(), to_pose(tag.at("pose")));
  } catch (const json::exception& e) {
    throw std::runtime_error("'" + path + "' is no truth.json: " + e.what());
  }
  return result;
}

estimates read_estimates(const std::string& path, std::size_t last_frames) {
  estimates result;
  frame_times times;
  for (const auto& line : last_lines(path, last_frames)) {
    try {
      add_frame(json::parse(line.text), result.poses, times);
    } catch (const json::exception& e) {
      throw std::runtime_error("'" + path + "', line "
                               + std::to_string(line.number)
                               + " is not from pose_estimation: " + e.what());
    }
  }
  result.timing = timing_of(times);
  return result;
}

namespace {

template <class... Values>
std::string row(const char* format, Values... values) {
  char line[160];
  std::snprintf(line, sizeof(line), format, values...);
  return std::string{line} + "\n";
}

std::string position(const Eigen::Vector3d& p) {
  char text[64];
  std::snprintf(text, sizeof(text), "%7.3f %7.3f %7.3f", p.x(), p.y(), p.z());
  return text;
}

std::string tag_row(const std::string& scene, const tag_comparison& tag) {
  auto truth = position(tag.truth.position);
  if (tag.frames == 0)
    return row("%-12s %4d  %s  not found", scene.c_str(), tag.id,
               truth.c_str());
  return row("%-12s %4d  %s  %s  %7.3f  %8.3f  %6zu", scene.c_str(), tag.id,
             truth.c_str(), position(tag.latest.position).c_str(),
             tag.error.distance_percent, tag.error.rotation_deg, tag.frames);
}

/// A number with so many decimals, or `-`.
std::string number(std::optional<double> value, int decimals) {
  char text[32] = "-";
  if (value)
    std::snprintf(text, sizeof(text), "%.*f", decimals, *value);
  return text;
}

/// What was found of nothing has no error.
std::optional<double> if_any(const summary& s, double value) {
  return s.found > 0 ? std::optional{value} : std::nullopt;
}

std::string summary_row(const std::string& name, const std::string& node,
                        const summary& s, const frame_timing& timing) {
  return row(
      "%-10.10s %-10.10s %9s %8s %7s %10s %7s %10s", name.c_str(),
      node.empty() ? "-" : node.c_str(),
      (std::to_string(s.found) + " of " + std::to_string(s.tags)).c_str(),
      number(if_any(s, s.mean.distance_mm), 2).c_str(),
      number(if_any(s, s.mean.distance_percent), 3).c_str(),
      number(if_any(s, s.mean.rotation_deg), 3).c_str(),
      number(timing.rate_hz, 1).c_str(), number(timing.latency_ms, 1).c_str());
}

/// What is not as the truth has it, in one line, or nothing.
std::string remarks(const scene_comparison& scene) {
  std::string missed;
  for (const auto& tag : scene.tags)
    if (tag.frames == 0)
      missed += " " + std::to_string(tag.id);
  std::string unknown_tags;
  for (auto id : scene.unknown_tags)
    unknown_tags += " " + std::to_string(id);
  std::string result;
  if (!missed.empty() && missed.size() < 60)
    result += scene.name + ": not found:" + missed + "\n";
  if (!unknown_tags.empty())
    result += scene.name + ": not in the scene:" + unknown_tags + "\n";
  return result;
}

} // namespace

std::string tag_table(const scene_comparison& scene) {
  auto result =
      row("%-12s %4s  %-23s  %-23s  %7s  %8s  %6s", "SCENE", "TAG",
          "TRUE X Y Z m", "ESTIMATED X Y Z m", "ERROR %", "TURNED °", "FRAMES");
  for (const auto& tag : scene.tags)
    result += tag_row(scene.name, tag);
  for (auto id : scene.unknown_tags)
    result += row("%-12s %4d  is not in the scene", scene.name.c_str(), id);
  return result;
}

std::string scene_table(const std::vector<scene_comparison>& scenes) {
  auto result =
      row("%-10s %-10s %9s %8s %7s %10s %7s %10s", "SCENE", "NODE", "FOUND",
          "ERROR mm", "ERROR %", "TURNED deg", "RATE Hz", "LATENCY ms");
  std::string below;
  for (const auto& scene : scenes) {
    result +=
        summary_row(scene.name, scene.node, summarize({scene}), scene.timing);
    below += remarks(scene);
  }
  return result + summary_row("all", {}, summarize(scenes), {}) + below;
}

std::string verdict(const summary& s, const pose_error& limit) {
  return row("%zu of %zu tags found; median errors %.3f %% of the distance and "
             "%.3f degrees, allowed %g %% and %g degrees: %s",
             s.found, s.tags, s.median.distance_percent, s.median.rotation_deg,
             limit.distance_percent, limit.rotation_deg,
             s.is_within(limit) ? "good" : "NOT GOOD");
}

} // namespace roscell::comparison
