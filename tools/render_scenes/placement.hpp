#pragma once

#include "tools/render_scenes/camera.hpp"

#include <vector>

namespace roscell::scenes {

/// The corners in pixels of a square of `size_m` around the middle of a tag:
/// bottom left, bottom right, top right, top left.
std::array<Eigen::Vector2d, 4> corners_of(const placed_tag& tag, double size_m,
                                          const camera& eye);

/// Random poses, the same for the same seed: tags 0, 1, ... in view with their
/// white margin of `margin` times the tag's size, none in front of another.
/// Where there are many, they begin farther away than `nearest_m`. Throws
/// std::runtime_error when so many do not fit.
std::vector<placed_tag> place_tags(const scene_options& options, double margin);

} // namespace roscell::scenes
