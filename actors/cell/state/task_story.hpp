#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/event_kinds.hpp"

#include <string>

/// How events about tasks are told: to whoever listens, and into the histories
/// of the tasks, which outlive them.
namespace roscell {

/// Tells an event about a task, or about what `subject` names of it.
void publish_task_event(coordinator_pointer self, const event_kind& what,
                        const std::string& task, const std::string& subject,
                        const json& data = json::object());

/// The same of what may be told again and again. It is written a little later,
/// together with what comes until then, or with the next event that is not of
/// that kind.
void publish_repeated_event(coordinator_pointer self, const event_kind& what,
                            const std::string& task, const std::string& subject,
                            const json& data);

/// Writes what waits, if it is time.
void write_due_events(coordinator_pointer self);

/// Errors: unknown_task.
caf::result<task_history> report_history(const cell_coordinator_state& st,
                                         const task_history_query& query);

} // namespace roscell
