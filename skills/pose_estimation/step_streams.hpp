#pragma once

#include "roscell/skill/environment.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// What the step of a pose estimator reads and writes.
namespace roscell::pose {

bool is_camera_info(const engine::stream& input);

/// Whether it is a message with an image, rather than a file.
bool is_image_message(const std::string& data_type);

/// Throws start_error for a type that the skill does not know.
void check_streams(const engine::environment& env);

/// A parameter that is a list with a text for each camera; all are empty where
/// it is absent. Throws start_error for any other number of texts.
std::vector<std::string> texts_of_cameras(const engine::parameters& options,
                                          const char* name,
                                          std::size_t cameras);

} // namespace roscell::pose
