#pragma once

#include "tools/compare_poses/comparison.hpp"

#include <string>
#include <vector>

namespace roscell::comparison {

/// One row per tag: id, true and latest estimated position, median errors.
std::string tag_table(const scene_comparison& scene);

/// One row per scene and one for all of them.
std::string scene_table(const std::vector<scene_comparison>& scenes);

} // namespace roscell::comparison
