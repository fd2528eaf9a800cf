#pragma once

#include "actors/cell/sets/set_plan.hpp"
#include "actors/cell/state/coordinator_state.hpp"

#include <optional>
#include <string>
#include <vector>

/// What the CELL COORDINATOR does for sets of tasks: `for_each` in a request.
/// Each node that a set is for has a task of its own, which the coordinator
/// asks itself for as any user would: started, changed and terminated through
/// the same requests. Sets stand in `st.sets`; what there is to do is worked
/// out anew whenever a node, a task or a set has changed, so that a coordinator
/// that ends at any moment goes on where it was.
///
/// Messages: task_set_request; task_termination of a set. Errors: see
/// `cell_coordinator_actor`.
namespace roscell {

/// The store's table of them.
constexpr const char* set_records = "task_sets";

/// Takes up the sets that an earlier run of the coordinator has stored.
void restore_sets(coordinator_pointer self);

caf::result<task_set_plan> apply_set(coordinator_pointer self,
                                     const task_set_request& request);

/// The set is no more, and then each of its tasks is terminated.
caf::result<task_terminated> remove_set(coordinator_pointer self,
                                        const task_termination& request);

/// Somebody terminates a task. Where that is one of a set it stays so until the
/// set is applied again.
void note_stopped_by_user(coordinator_pointer self, const std::string& task);

/// Why a request cannot have its task's name, or its set; null: it can.
std::optional<failure> why_not_of_set(const cell_coordinator_state& st,
                                      const std::string& task,
                                      const std::string& request);

/// Why a task cannot be changed into this request by itself; null: it can. One
/// of a set is what the set says, which would put it back.
/// @param body `body_of` the request; empty: another one than it has.
std::optional<failure> why_kept_by_set(const cell_coordinator_state& st,
                                       const std::string& task,
                                       const std::string& body);

/// Does what is to be done, if it is time to look.
void settle_due_sets(coordinator_pointer self);

/// What a set means for the nodes and tasks that there are.
std::vector<set_step> plan_of_set(const cell_coordinator_state& st,
                                  const set_table::entry& set);

/// How a set stands.
task_set_row describe_set(const cell_coordinator_state& st,
                          const std::string& set);
task_set_row describe_set(const cell_coordinator_state& st,
                          const std::string& set,
                          const std::vector<set_step>& steps);

} // namespace roscell
