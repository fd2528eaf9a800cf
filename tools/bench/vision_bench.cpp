#include "tools/bench/vision_modes.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace roscell::bench {

double quantile(std::vector<double> values, double q) {
  if (values.empty())
    return 0;
  const auto last = static_cast<double>(values.size() - 1);
  const auto there =
      values.begin() + static_cast<std::ptrdiff_t>(std::floor(q * last));
  std::nth_element(values.begin(), there, values.end());
  return *there;
}

} // namespace roscell::bench

namespace {

using namespace roscell::bench;

void add_poses(CLI::App& app, pose_options& options) {
  auto& mode = *app.add_subcommand(
      "poses",
      "Time of a frame in the skill pose_estimation beside the AprilTag "
      "library's");
  mode.add_option("SCENES", options.scenes, "Folders of render_scenes")
      ->required();
  mode.add_option("--rounds", options.rounds, "How often each frame is taken")
      ->check(CLI::Range(1, 100'000));
  mode.add_option("--decimation", options.decimation, "Of both")
      ->check(CLI::Range(1.0, 16.0));
  mode.callback([&options] { compare_times_of_poses(options); });
}

void add_encodings(CLI::App& app, unsigned& rounds) {
  auto& mode = *app.add_subcommand(
      "encodings", "Time of vision::to_gray for YUV and Bayer beside "
                   "cv::cvtColor's, on one core");
  mode.add_option("--rounds", rounds, "How often each takes the image")
      ->check(CLI::Range(1, 100'000));
  mode.callback([&rounds] { compare_times_of_encodings(rounds); });
}

void add_bundles(CLI::App& app, bundle_options& options) {
  auto& mode = *app.add_subcommand(
      "bundles", "Errors of the pose of a board with four tags beside those of "
                 "each tag alone");
  mode.add_option("FAMILIES", options.families, "Of the tags")->required();
  mode.add_option("--poses", options.poses, "Random poses of each family")
      ->check(CLI::Range(1, 100'000));
  mode.add_option("--seed", options.seed, "Another seed gives other poses");
  mode.callback([&options] { compare_errors_of_bundles(options); });
}

} // namespace

/// The vision skills beside what they are made with. The sides of a comparison
/// take turns, so that both meet the same state of the machine.
int main(int argc, char** argv) {
  CLI::App app{
      "Compares the vision skills with the libraries that they use, as "
      "JSON lines."};
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  pose_options poses;
  auto rounds = 200U;
  bundle_options bundles;
  add_poses(app, poses);
  add_encodings(app, rounds);
  add_bundles(app, bundles);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  } catch (const std::exception& e) {
    std::cerr << "vision_bench: " << e.what() << '\n';
    return 1;
  }
}
