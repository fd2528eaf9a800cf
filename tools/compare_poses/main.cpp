#include "tools/compare_poses/reading.hpp"
#include "tools/compare_poses/table.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>

namespace {

using namespace roscell::comparison;
namespace fs = std::filesystem;

struct arguments {
  std::vector<std::string> files;
  std::size_t last_frames = 0;
  bool summary_only = false;
  pose_error limit{1, 2};
};

void add_options(CLI::App& app, arguments& given) {
  app.option_defaults()->always_capture_default();
  app.add_option("FILES", given.files,
                 "Pairs of a scene's folder, or its truth.json, and the JSON "
                 "lines of pose_estimation")
      ->required();
  app.add_option("--last", given.last_frames,
                 "Only so many of the newest frames of a scene; 0: all");
  app.add_flag("--summary", given.summary_only, "Scenes only, not each tag");
  app.add_option("--most-error", given.limit.distance_percent,
                 "Most median error of the position, in percent of the "
                 "distance");
  app.add_option("--most-turned", given.limit.rotation_deg,
                 "Most median error of the orientation, in degrees");
}

scene_comparison compare_files(fs::path truth, const std::string& poses,
                               std::size_t last_frames) {
  if (fs::is_directory(truth))
    truth /= "truth.json";
  auto name = fs::absolute(truth).parent_path().filename().string();
  return compare(name, read_truth(truth), read_estimates(poses, last_frames));
}

bool compare_all(const arguments& given) {
  if (given.files.size() % 2 != 0)
    throw std::runtime_error("FILES must be pairs: SCENE POSES SCENE POSES...");
  std::vector<scene_comparison> scenes;
  for (std::size_t i = 0; i < given.files.size(); i += 2) {
    scenes.push_back(
        compare_files(given.files[i], given.files[i + 1], given.last_frames));
    if (!given.summary_only)
      std::cout << tag_table(scenes.back()) << '\n';
  }
  std::cout << scene_table(scenes);
  return summarize(scenes).is_within(given.limit);
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
    return compare_all(given) ? 0 : 1;
  } catch (const std::exception& e) {
    std::cerr << "compare_poses: " << e.what() << '\n';
    return 2;
  }
}
