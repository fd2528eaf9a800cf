#pragma once

#include "actors/instances/skills/skill_catalogue.hpp"
#include "actors/node/node_runtime.hpp"
#include "roscell/node_config.hpp"

#include <caf/expected.hpp>

#include <string>
#include <vector>

namespace roscell {

/// The skills in the folders of a node, and those whose instances are actors of
/// this process, by their descriptors. Blocks on the disk. What is wrong in a
/// folder is among the problems of the catalogue.
///
/// Errors: schema_violation (a descriptor in `actor_skills`).
caf::expected<shared_skill_catalogue>
offered_skills(const node_config& config, const chosen_runtime& runtime,
               const std::vector<std::string>& actor_skills);

} // namespace roscell
