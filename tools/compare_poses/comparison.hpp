#pragma once

#include <Eigen/Geometry>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell::comparison {

/// Of a tag in the camera's optical frame.
struct pose {
  Eigen::Vector3d position; ///< metres
  Eigen::Quaterniond orientation;
};

/// By tag id.
using true_poses = std::map<int, pose>;

/// By tag id, one pose per frame in which the tag was found.
using estimated_poses = std::map<int, std::vector<pose>>;

/// How fast poses come; nothing where the frames do not tell.
struct frame_timing {
  std::optional<double> rate_hz;
  std::optional<double> latency_ms; ///< Median, from an image to its poses.
};

/// What an estimator has told.
struct estimates {
  estimated_poses poses;
  frame_timing timing;
};

/// How far an estimate is from the truth.
struct pose_error {
  /// Distance between the two positions, in percent of the true distance from
  /// the camera.
  double distance_percent = 0;
  double rotation_deg = 0;
  double distance_mm = 0; ///< Between the two positions.
};

pose_error error_of(const pose& estimate, const pose& truth);

/// A true tag and what was estimated of it. Errors are medians over frames.
struct tag_comparison {
  int id = 0;
  pose truth;
  std::size_t frames = 0; ///< In how many the tag was found; 0: never.
  pose_error error;
  pose latest;
};

struct scene_comparison {
  std::string name;
  std::string node; ///< Where its poses are estimated, if that is known.
  std::vector<tag_comparison> tags; ///< In the order of ids.
  std::vector<int> unknown_tags;    ///< Tags that are not in the scene.
  std::vector<pose_error> errors;   ///< Of each tag in each frame.
  frame_timing timing;
};

scene_comparison compare(std::string name, const true_poses& truth,
                         const estimates& estimated);

/// 0 of nothing.
double median(std::vector<double> values);

/// What one or more scenes come to.
struct summary {
  std::size_t tags = 0;
  std::size_t found = 0;
  pose_error median; ///< Over all tags and frames.
  pose_error mean;   ///< The same.

  /// Whether every tag was found and neither median is above its limit, of
  /// percent and degrees.
  bool is_within(const pose_error& limit) const;
};

summary summarize(const std::vector<scene_comparison>& scenes);

/// Reads a truth.json of render_scenes. Throws std::runtime_error, naming the
/// file and what is wrong.
true_poses read_truth(const std::string& path);

/// Reads the JSON lines that the skill pose_estimation writes, the newest
/// `last_frames` of them, or all if that is 0. A last line without its newline
/// is still being written, and left out. Throws std::runtime_error, naming the
/// file and line.
estimates read_estimates(const std::string& path, std::size_t last_frames);

/// One row per tag: id, true and latest estimated position, median errors.
std::string tag_table(const scene_comparison& scene);

/// One row per scene and one for all of them, with the means of the errors, and
/// a line for each scene with tags that were missed or not expected. At most 80
/// columns wide, unless those are many.
std::string scene_table(const std::vector<scene_comparison>& scenes);

/// One line: what was found, the medians of the errors, and whether they are
/// within the limit.
std::string verdict(const summary& s, const pose_error& limit);

} // namespace roscell::comparison
