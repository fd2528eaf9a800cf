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

std::string summary_row(const std::string& name, const summary& s) {
  return row("%-12s %4zu  %5zu  %7.3f  %8.3f", name.c_str(), s.tags, s.found,
             s.median.distance_percent, s.median.rotation_deg);
}

} // namespace

std::string tag_table(const scene_comparison& scene) {
  auto result =
      row("%-12s %4s  %-23s  %-23s  %7s  %8s  %6s", "SCENE", "TAG",
          "TRUE X Y Z m", "ESTIMATED X Y Z m", "ERROR %", "TURNED °", "FRAMES");
  for (const auto& tag : scene.tags)
    result += tag_row(scene.name, tag);
  for (auto id : scene.strangers)
    result += row("%-12s %4d  is not in the scene", scene.name.c_str(), id);
  return result;
}

std::string scene_table(const std::vector<scene_comparison>& scenes) {
  auto result = row("%-12s %4s  %5s  %7s  %8s", "SCENE", "TAGS", "FOUND",
                    "ERROR %", "TURNED °");
  for (const auto& scene : scenes)
    result += summary_row(scene.name, summarize({scene}));
  return result + summary_row("all", summarize(scenes));
}

} // namespace roscell::comparison
