#pragma once

#include "actors/instances/exec/exec_host.hpp"

#include <caf/result.hpp>

/// INTERNAL to the exec host: what happens to a command once it has begun. All
/// of it is in `exec_host_state`. Errors: unknown_task (there is no such
/// command), conflict (another offset), schema_violation (no base64).
namespace roscell {

using exec_host_pointer = exec_host_actor::stateful_pointer<exec_host_state>;

caf::result<exec_input_taken> take_input(exec_host_pointer self,
                                         const exec_input& request);

caf::result<exec_output> give_output(exec_host_pointer self,
                                     const exec_output_query& query);

/// Something has come of a command; of one that is forgotten nothing is wanted.
void on_progress(exec_host_pointer self, const exec_progress& event);

/// Answers those whose time is over, and ends commands that nobody wants.
void on_alarm(exec_host_pointer self);

/// As early as anything is due.
void set_alarm(exec_host_pointer self);

} // namespace roscell
