#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <string>

namespace roscell {

/// Why an engine could not pull an image, as a person can do something about
/// it: with the registry's name, and the remedy.
/// @param engine "docker" or "podman".
/// @param said the engine's words.
edge_error pull_refusal(const std::string& engine, const std::string& image,
                        const std::string& said);

/// The same of a registry that has said nothing for too long.
edge_error pull_silence(const std::string& engine, const std::string& image);

} // namespace roscell
