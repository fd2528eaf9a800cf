#pragma once

#include "messages/failure.hpp"
#include "messages/task_set.hpp"

#include <string>
#include <variant>

/// What a set of tasks means for one node. Pure.
namespace roscell {

/// What tells one request of a set from another, as JSON: the way in which it
/// is carried out does not.
std::string body_of(task_set_request request);

/// "<set>-<node>"
std::string task_name(const std::string& set, const std::string& node);

/// The request of a node's task: with the node's name in place of `${node}`,
/// its copies made, and its steps on that node, but for those that may run
/// anywhere. Errors: schema_violation (a name that is too long, and those of
/// copies).
std::variant<task_request, failure> task_for(const task_set_request& set,
                                             const std::string& node);

} // namespace roscell
