#pragma once

#include "tools/render_scenes/scene.hpp"

#include <string>

namespace roscell::scenes {

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
