#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>
#include <vector>

/// Where nodes get the builds that they lack.
namespace roscell {

/// A key for a node that gives builds to others.
std::string new_build_key();

/// Who gives a build of the cell to that node, with permits for it: each node
/// that has it, and those `beside` that get it now. No hash: the node has it,
/// or it is none of the cell's.
build_offer offer_for(const cell_coordinator_state& st, const std::string& hash,
                      const std::string& node,
                      const std::vector<std::string>& beside = {});

/// The same of any build, from these nodes.
build_offer offer_from(const cell_coordinator_state& st,
                       const build_name& build, const std::string& node,
                       const std::vector<std::string>& givers);

/// The same for each step of a task that is about to start.
std::vector<build_offer> offers_for(const cell_coordinator_state& st,
                                    const std::vector<instance_spec>& specs,
                                    const std::vector<std::string>& nodes);

/// Names of the nodes that have the build as a skill.
std::vector<std::string> nodes_with(const cell_coordinator_state& st,
                                    const std::string& hash);

/// The same of one of the cell's builds, from all that have it.
build_offer offer_of(const cell_coordinator_state& st, const cell_build& build,
                     const std::string& node,
                     const std::vector<std::string>& beside = {});

/// The cell's builds with where they are needed.
std::vector<cell_build> describe_builds(const cell_coordinator_state& st,
                                        const skill_query& query);

/// The skills of all nodes, and those of the cell that nodes can get.
skill_list skills_within_reach(const cell_coordinator_state& st);

} // namespace roscell
