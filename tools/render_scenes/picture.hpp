#pragma once

#include "tools/render_scenes/scene.hpp"

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace roscell::scenes {

/// A family's tags as black and white cells, as the AprilTag library draws
/// them.
class tag_sheet {
public:
  /// Throws std::runtime_error when the family is unknown, or has fewer tags.
  tag_sheet(const std::string& family, unsigned tags);

  /// Across the square whose corners AprilTag finds: a tag's size.
  int border_cells() const;

  /// Across all that is printed.
  int sheet_cells() const;

  /// Width of what lies around that square as a part of the tag's size.
  double margin() const;

  /// 1 for white and 0 for black at a place on tag `id`, in units of the tag's
  /// size from its middle, x to the right and y up; negative off the sheet.
  int shade(int id, double x, double y) const;

private:
  std::vector<cv::Mat> cells_;
  double border_cells_ = 0;
};

/// All families of the AprilTag library.
std::vector<std::string> family_names();

/// The scene as a perfect camera sees it, on a background of soft shapes: each
/// pixel is the mean of 6 x 6 rays. 8 bits, one channel.
cv::Mat draw_scene(const scene_options& options, const tag_sheet& sheet,
                   const std::vector<placed_tag>& tags);

/// What a camera makes of it: blur, and noise that is new in each frame.
cv::Mat expose(const cv::Mat& scene, const scene_options& options,
               unsigned frame);

/// Renders a scene into `folder`, which is made if need be: frame_000.png and
/// on; camera.json, the calibration with ROS's names; truth.json:
///
///     { "family": "tag36h11", "tag_size_m": 0.16, "tags": [ { "id": 0,
///       "pose": { "position": [x, y, z], "orientation": [x, y, z, w] },
///       "corners_px": [[x, y], ...] } ] }
///
/// Throws std::runtime_error when that is impossible.
void render_scene(const scene_options& options, const std::string& folder);

} // namespace roscell::scenes
