#pragma once

#include <string>
#include <vector>

/// What vision_bench compares: each mode prints one JSON line a scene, encoding
/// or family on standard output, and throws where it cannot begin.
namespace roscell::bench {

/// The skill pose_estimation (image message in, poses and detections out)
/// beside the AprilTag library alone on the same pixels, by wall time.
struct pose_options {
  std::vector<std::string> scenes; ///< Folders of render_scenes.
  unsigned rounds = 20;            ///< How often each frame is taken.
  float decimation = 2;            ///< Of both.
};

void compare_times_of_poses(const pose_options& options);

/// What makes gray of YUV and Bayer beside cv::cvtColor on the same 1920 x 1080
/// pixels, by the processor time of one core. Each takes an image so many
/// times.
void compare_times_of_encodings(unsigned rounds);

/// Errors of the pose of a board with four tags beside those of each tag alone,
/// in rendered pictures.
struct bundle_options {
  std::vector<std::string> families;
  unsigned poses = 40; ///< Random ones, of each family.
  unsigned seed = 1;
};

void compare_errors_of_bundles(const bundle_options& options);

/// The least value that a share `q` of all does not exceed; 0 of none.
double quantile(std::vector<double> values, double q);

/// Does the work, and adds how many milliseconds of that clock it takes;
/// `now()` is a time in nanoseconds.
template <class Now, class Work>
void measure(std::vector<double>& times_ms, Now now, Work work) {
  const auto start = now();
  work();
  times_ms.push_back(static_cast<double>((now() - start).count()) / 1e6);
}

} // namespace roscell::bench
