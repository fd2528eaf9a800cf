#pragma once

#include "skills/pose_estimation/frame_result.hpp"
#include "skills/vision/image_codec.hpp"

#include <optional>

namespace roscell::pose {

/// Draws what was found into a bgr8 picture of the same size as the image:
/// the outline of each tag in yellow with its bottom edge in magenta, its id,
/// and, if it has a pose, its axes x in red, y in green, z in blue, half as
/// long as the tag is wide.
void draw_overlay(const frame_result& result,
                  const std::optional<camera_model>& camera,
                  vision::picture& target);

} // namespace roscell::pose
