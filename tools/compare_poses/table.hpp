#pragma once

#include "tools/compare_poses/comparison.hpp"

#include <string>
#include <vector>

namespace roscell::comparison {

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
