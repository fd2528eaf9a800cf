#pragma once

#include "actors/cell/tables/deployment_table.hpp"
#include "messages/inside/placement.hpp"
#include "messages/task_update.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// What differs between a task as it runs and as a request says. Pure.
namespace roscell {

/// A step of the new request.
struct planned_step {
  resolved_step step;
  std::optional<deployment> old; ///< What it has now.
  step_change change;            ///< Without the node of a new instance.

  /// Whether it is to have another instance.
  bool is_fresh() const {
    return change.action != step_action::stays;
  }
};

struct update_plan {
  std::vector<planned_step> steps;   ///< In the order of the request.
  std::vector<deployment> dropped;   ///< Of steps that it has no more.
  std::vector<std::string> reasons;  ///< What differs of the task as a whole.
  std::vector<std::string> warnings; ///< Of reading the request.

  bool changes_steps() const;

  /// Whether there is nothing to do, not even to write.
  bool is_empty() const {
    return reasons.empty() && !changes_steps();
  }

  /// The instances that the task has no more.
  std::vector<deployment> former() const;

  /// One a step; those that are no more come last.
  std::vector<step_change> changes() const;
};

struct update_question {
  std::vector<deployment> placed; ///< What the task has, nothing tentative.
  std::vector<resolved_step> steps;
  std::set<std::string> away; ///< Nodes that cannot be asked now.
  /// The labels of each node that has some of it.
  std::map<std::string, std::map<std::string, std::string>> labels;
  /// Names of what the cell itself adds to every environment.
  std::set<std::string> cell_environment;
  bool restart_all = false;
};

/// A step stays if what it would be on its node is what it is there. One whose
/// node is away stays unless what is written of it differs. A step that reads
/// or writes the files of one that stays is to be on the same node.
update_plan compare_steps(const update_question& question);

/// What differs between two requests of a task, but for their steps.
std::vector<std::string> compare_requests(const task_request& before,
                                          const task_request& now);

} // namespace roscell
