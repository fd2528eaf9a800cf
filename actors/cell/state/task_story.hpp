#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// How facts about tasks are told: to whoever listens, and into the histories
/// of the tasks, which outlive them.
namespace roscell {

/// Tells a fact about a task, or about what `subject` names of it.
void tell_of_task(coordinator_pointer self, const char* what,
                  const std::string& task, const std::string& subject,
                  const json& data = json::object());

/// Errors: unknown_task.
caf::result<task_history> tell_history(const cell_coordinator_state& st,
                                       const task_history_query& query);

} // namespace roscell
