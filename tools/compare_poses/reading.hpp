#pragma once

#include "tools/compare_poses/comparison.hpp"

#include <string>

namespace roscell::comparison {

/// Reads a truth.json of render_scenes. Throws std::runtime_error, naming the
/// file and what is wrong.
true_poses read_truth(const std::string& path);

/// Reads the JSON lines that the skill pose_estimation writes, the newest
/// `last_frames` of them, or all if that is 0. A last line without its newline
/// is still being written, and left out. Throws std::runtime_error, naming the
/// file and line.
estimates read_estimates(const std::string& path, std::size_t last_frames);

} // namespace roscell::comparison
