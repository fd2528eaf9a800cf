#include "tools/compare_poses/table.hpp"

#include <cstdio>

namespace roscell::comparison {

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
