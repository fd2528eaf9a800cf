#pragma once

#include "actors/placement/questions/step_ways.hpp"
#include "actors/placement/search/problem.hpp"
#include "messages/inside/placement.hpp"

#include <string>
#include <vector>

/// From messages to what the search works on.
namespace roscell {

/// Position of a step; the number of steps if there is none of that id.
size_t step_position(const std::vector<resolved_step>& steps,
                     const std::string& id);

/// Position of a node; the number of nodes if there is none of that name.
size_t node_position(const std::vector<node_resources>& nodes,
                     const std::string& name);

std::vector<step_ways> ways_of(const std::vector<resolved_step>& steps);

/// Excluded from it is only what nodes do not grant.
allocation::problem make_problem(const std::vector<node_resources>& nodes,
                                 const std::vector<step_ways>& ways);

} // namespace roscell
