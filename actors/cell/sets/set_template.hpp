#pragma once

#include "messages/failure.hpp"
#include "messages/task_set.hpp"

#include <map>
#include <memory>
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

/// What a set means for a node, worked out once.
struct node_task {
  task_request request;
  std::string body;    ///< `body_of` it.
  std::string problem; ///< Why there is none; empty: there is.
};

/// Those of one request of a set, by node. Of hundreds of nodes each would be
/// worked out anew whenever one of them has changed.
class node_tasks {
public:
  std::shared_ptr<const node_task> of(const task_set_request& set,
                                      const std::string& node);

  /// The set has another request.
  void clear() {
    known_.clear();
  }

  /// Nodes that are no more are forgotten once there are more than these.
  void keep_within(size_t most);

private:
  std::map<std::string, std::shared_ptr<const node_task>> known_;
};

} // namespace roscell
