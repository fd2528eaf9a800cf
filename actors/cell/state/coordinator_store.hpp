#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/event_kinds.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR writes its records down.
namespace roscell {

/// Writes records, and removes those whose value is empty, all or none. Calls
/// one of the two: `kept` when they are on disk, `not_persisted` with the
/// reason and a remedy when they are not, which is told as an event too.
/// Without a store everything is kept at once.
void keep_records(coordinator_pointer self, std::vector<store_record> records,
                  std::function<void()> kept,
                  std::function<void(const failure&)> not_persisted);

/// Removes a new record that was refused: a write whose answer did not come in
/// time may still be carried out, and the store writes in order.
void forget_refused(coordinator_pointer self, std::string table,
                    std::string key);

/// Writes down what has happened already and cannot be refused any more: a full
/// disk is written when it has room. A store that fails otherwise is told of.
void persist_record(coordinator_pointer self, store_record record);

/// Tells all other coordinators that rows have changed or are gone.
void publish(coordinator_pointer self,
             const std::vector<std::string>& changed_uuids,
             const std::vector<std::string>& gone_uuids = {});

/// Forgets a node: its row, its record, and what others have heard of it.
void drop_row(coordinator_pointer self, const std::string& uuid);

// How events about tasks are told: to whoever listens, and into the histories
// of the tasks, which outlive them.

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
caf::result<task_history> report_history(coordinator_pointer self,
                                         const task_history_query& query);

} // namespace roscell
