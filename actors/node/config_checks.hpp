#pragma once

#include "actors/edge/process/skill_grants.hpp"
#include "actors/node/node_runtime.hpp"
#include "roscell/node_config.hpp"

#include <caf/error.hpp>

#include <string>

namespace roscell {

/// Checks the options of a node and fills in what was left out: its name, cell
/// and address.
///
/// Errors: schema_violation (an option, named), unreachable (the address is not
/// of this host).
caf::error complete_config(node_config& config);

/// Checks that the name, the cell, the labels and the devices of a node can be
/// said in messages. Errors: schema_violation (an option, named).
caf::error check_words(const node_config& config);

// What the configuration of a node grants to skills, against what the node
// itself may.

/// Why a grant cannot be meant: its form, a user that does not exist. Empty: it
/// can. Looks users up.
std::string grant_problem(const std::string& line);

/// Errors: schema_violation (a grant that cannot be meant), unauthorized (one
/// of what this node may not do itself).
caf::error check_grants(const node_config& config,
                        const chosen_runtime& runtime);

/// Those of a configuration that has been checked.
shared_skill_grants grants_in(const node_config& config);

} // namespace roscell
