#pragma once

#include "messages/task_update.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Sets of tasks: one task that each node of a kind has of its own.
namespace roscell {

/// Which nodes a set is for.
struct node_choice {
  std::map<std::string, std::string> labels; ///< All of them; none: any node.

  static constexpr auto fields() {
    return field_list{optional("labels", &node_choice::labels)};
  }
};

struct set_policy {
  node_choice node;
  int64_t at_once = 1; ///< How many of its tasks are changed at a time.

  static constexpr auto fields() {
    return field_list{required("node", &set_policy::node),
                      optional("at_once", &set_policy::at_once)};
  }
};

/// Makes a set of tasks, or changes it: each node that it is for gets one, also
/// those that come later, under the name "<task>-<node>". In texts of a step
/// `${node}` stands for the node's name. Answered once the set is written down;
/// how it goes on is in `task_set_row`.
struct task_set_request {
  static constexpr const char* type = "task_set_request";
  std::string task; ///< Name of the set.
  set_policy for_each;
  std::vector<task_step> pipeline;
  double timeout_s = 0;                      ///< As in `task_request`.
  std::map<std::string, std::string> labels; ///< The same, for each task.
  update_policy update;                      ///< The same.
  bool dry_run = false;   ///< It is only shown what would be done.
  bool run_again = false; ///< Those that have ended are started once more.
  bool only_new = false;  ///< A set of that name with another request stays.
  bool force = false;     ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("task", &task_set_request::task),
                      required("for_each", &task_set_request::for_each),
                      required("pipeline", &task_set_request::pipeline),
                      optional("timeout_s", &task_set_request::timeout_s),
                      optional("labels", &task_set_request::labels),
                      optional("update", &task_set_request::update),
                      optional("dry_run", &task_set_request::dry_run),
                      optional("run_again", &task_set_request::run_again),
                      optional("only_new", &task_set_request::only_new),
                      optional("force", &task_set_request::force)};
  }
};

/// What the task of one node does.
enum class set_action {
  stays,
  starts,  ///< The node has none.
  runs,    ///< It has ended, and is started once more.
  changes, ///< It has another request.
  stops,   ///< The set is not for that node, or not any more.
};

constexpr auto enum_words(set_action) {
  return std::array<std::string_view, 5>{"stays", "starts", "runs", "changes",
                                         "stops"};
}

struct set_change {
  std::string node;
  std::string task;
  set_action action = set_action::stays;
  std::string reason; ///< One sentence; empty: there is nothing to say.

  static constexpr auto fields() {
    return field_list{required("node", &set_change::node),
                      required("task", &set_change::task),
                      required("action", &set_change::action),
                      optional("reason", &set_change::reason)};
  }
};

/// Reply to `task_set_request`.
struct task_set_plan {
  static constexpr const char* type = "task_set_plan";
  std::string task; ///< Name of the set.
  update_outcome outcome = update_outcome::unchanged;
  bool is_new = false;             ///< The cell did not have the set.
  std::vector<set_change> changes; ///< One a node; none: it is for no node yet.

  static constexpr auto fields() {
    return field_list{required("task", &task_set_plan::task),
                      required("outcome", &task_set_plan::outcome),
                      optional("is_new", &task_set_plan::is_new),
                      required("changes", &task_set_plan::changes)};
  }
};

} // namespace roscell
