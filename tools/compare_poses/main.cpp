#include "tools/compare_poses/comparison.hpp"
#include "tools/compare_poses/live_text.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace {

using namespace roscell::comparison;
namespace fs = std::filesystem;
using clock_type = file_watch::clock;
using seconds = std::chrono::duration<double>;

struct arguments {
  std::vector<std::string> files;
  std::vector<std::string> nodes;
  std::size_t last_frames = 0;
  std::size_t frames = 1;
  double wait_s = 0;
  bool watch = false;
  bool summary_only = false;
  pose_error limit{1, 2};
};

void add_options(CLI::App& app, arguments& given) {
  app.option_defaults()->always_capture_default();
  app.add_option("FILES", given.files,
                 "Pairs of a scene's folder, or its truth.json, and the JSON "
                 "lines of pose_estimation")
      ->required();
  app.add_option("--nodes", given.nodes,
                 "For each pair, the node on which its poses are estimated")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--last", given.last_frames,
                 "Only so many of the newest frames of a scene; 0: all");
  app.add_flag("--summary", given.summary_only, "Scenes only, not each tag");
  app.add_flag("--watch", given.watch,
               "Show the tables again and again while the lines come in");
  app.add_option("--wait", given.wait_s,
                 "Wait at most so many seconds for every tag to be found")
      ->check(CLI::Range(0.0, 86'400.0));
  app.add_option("--frames", given.frames,
                 "In how many frames a tag must be found");
  app.add_option("--most-error", given.limit.distance_percent,
                 "Most median error of the position, in percent of the "
                 "distance");
  app.add_option("--most-turned", given.limit.rotation_deg,
                 "Most median error of the orientation, in degrees");
}

/// A file that is not there yet holds no lines while they are waited for.
estimates read_lines(const std::string& path, const arguments& given) {
  auto may_come = given.watch || given.wait_s > 0;
  if (may_come && !fs::exists(path))
    return {};
  return read_estimates(path, given.last_frames);
}

std::vector<scene_comparison> compare_all(const arguments& given) {
  std::vector<scene_comparison> scenes;
  for (std::size_t i = 0; i < given.files.size(); i += 2) {
    fs::path truth = given.files[i];
    if (fs::is_directory(truth))
      truth /= "truth.json";
    auto name = fs::absolute(truth).parent_path().filename().string();
    scenes.push_back(compare(name, read_truth(truth),
                             read_lines(given.files[i + 1], given)));
    if (i / 2 < given.nodes.size())
      scenes.back().node = given.nodes[i / 2];
  }
  return scenes;
}

bool is_complete(const std::vector<scene_comparison>& scenes,
                 std::size_t frames) {
  for (const auto& scene : scenes)
    for (const auto& tag : scene.tags)
      if (tag.frames < frames)
        return false;
  return true;
}

std::string tables(const std::vector<scene_comparison>& scenes,
                   const arguments& given) {
  std::string tags;
  if (!given.summary_only)
    for (const auto& scene : scenes)
      tags += tag_table(scene) + "\n";
  // A live text is cut at its end, another one is read from its end.
  if (given.watch && !tags.empty())
    return scene_table(scenes) + "\n" + tags;
  return tags + scene_table(scenes);
}

/// Shows tables again and again.
class display {
public:
  explicit display(const arguments& given) : given_(given) {
    // nop
  }

  /// How long a table is left to be read. In a file, a table now and then is
  /// enough.
  static std::chrono::seconds pace() {
    return std::chrono::seconds{stdout_screen() ? 1 : 30};
  }

  void show(const std::vector<scene_comparison>& scenes) {
    auto text = tables(scenes, given_);
    if (const auto screen = stdout_screen())
      text = text_.repainted(text, *screen);
    std::cout << text << std::flush;
  }

private:
  const arguments& given_;
  live_text text_;
};

clock_type::time_point end_of_waiting(const arguments& given) {
  if (given.wait_s <= 0)
    return clock_type::time_point::max();
  return clock_type::now()
         + std::chrono::duration_cast<clock_type::duration>(
             seconds{given.wait_s});
}

/// Waits while lines come in, and shows them if that is wanted.
std::vector<scene_comparison> follow(const arguments& given) {
  // Lines may come a hundred times a second.
  constexpr std::chrono::milliseconds least_pace{300};
  const auto end = end_of_waiting(given);
  const clock_type::duration pace =
      given.watch ? clock_type::duration{display::pace()} : least_pace;
  std::vector<std::string> lines;
  for (std::size_t i = 1; i < given.files.size(); i += 2)
    lines.push_back(given.files[i]);
  file_watch changes{lines};
  display shown{given};
  for (;;) {
    auto begun = clock_type::now();
    auto scenes = compare_all(given);
    if (given.wait_s > 0 && is_complete(scenes, given.frames))
      return scenes;
    if (given.watch)
      shown.show(scenes);
    if (!changes.wait_until(end) && clock_type::now() >= end)
      return scenes;
    // What comes within the pace is shown with what comes first.
    while (changes.wait_until(std::min(end, begun + pace))) {
      // More lines have come.
    }
  }
}

bool run(const arguments& given) {
  if (given.files.size() % 2 != 0)
    throw std::runtime_error("FILES must be pairs: SCENE POSES SCENE POSES...");
  auto scenes =
      given.watch || given.wait_s > 0 ? follow(given) : compare_all(given);
  const auto all = summarize(scenes);
  std::cout << tables(scenes, given) << verdict(all, given.limit) << std::flush;
  return is_complete(scenes, given.frames) && all.is_within(given.limit);
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Compares estimated poses of tags with true ones. Exit code 0 "
               "if every tag was found\nand the median errors are within "
               "their limits, 1 if not, 2 if a file is not as it should be."};
  arguments given;
  add_options(app, given);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(given) ? 0 : 1;
  } catch (const std::exception& e) {
    std::cerr << "compare_poses: " << e.what() << '\n';
    return 2;
  }
}
