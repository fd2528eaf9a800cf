#pragma once

#include "actors/instances/container_supervisor.hpp"

#include <caf/result.hpp>
#include <caf/system_messages.hpp>

#include <string>

/// INTERNAL to the container supervisor: the steps that its files share, from
/// the spawning of instances over their logs to their removal. What they change
/// is in `container_supervisor_state`. Errors: unknown_task; a removal that has
/// to wait is no error, its reply names the instances that are not stop-safe.
namespace roscell {

using container_supervisor_pointer =
    container_supervisor_actor::stateful_pointer<container_supervisor_state>;

/// Null if there is none of that id.
supervised_instance* find_instance(container_supervisor_pointer self,
                                   const std::string& instance);

/// Removes an ended instance's record and row, and puts its log into the
/// history.
void clean_instance(container_supervisor_pointer self,
                    const std::string& instance);

/// Keeps the newest rows of ended instances only, of older ones those that the
/// coordinator does not know to have ended, without what they left.
void trim_ended(container_supervisor_pointer self);

/// The coordinator keeps that these have ended.
void acknowledge_ends(container_supervisor_pointer self,
                      const std::vector<std::string>& instances);

/// An instance that is to go is not stop-safe yet: whoever wants it gone hears
/// that.
void on_removal_waits(container_supervisor_pointer self,
                      const instance_row& row);

/// Ends one instance or all of a task, and replies when they are gone or wait
/// to be stop-safe.
caf::result<instances_removed>
remove_instances(container_supervisor_pointer self,
                 const instance_removal& request);

/// What the program of an instance asks for itself, as long as its cell lets
/// it, is asked of the cell as a user would. It hears what has become of it.
void ask_for_parameters(container_supervisor_pointer self,
                        const instance_row& row,
                        const instance_notified& asked);

// The actors of instances and the runtime, from their start over their deaths
// to their successors.

/// Makes the actor of an instance. With `adopt` its program may run already;
/// where that is so and there is a `renewal`, it is started again for that
/// reason.
void spawn_actor(container_supervisor_pointer self, supervised_instance& x,
                 bool adopt, const std::string& renewal = {});

/// It has become known where programs find the cell now: what waits for that is
/// started, and what an earlier run of the node has started at another address
/// is started again: the sockets of those programs are bound to that, and do
/// not follow. Not before: what is told an earlier place gets no data there,
/// and is not told again.
void take_place(container_supervisor_pointer self,
                const use_environment& place);

/// An instance has ended: whoever waits for it hears why.
void on_ended(container_supervisor_pointer self, const std::string& instance,
              supervised_instance& x);

void start_runtime(container_supervisor_pointer self);

/// The runtime, or the actor of an instance, has died.
void on_down(container_supervisor_pointer self, const caf::down_msg& down);

/// A word of this node has reached its coordinator.
void on_contact(container_supervisor_pointer self, const contact_proven& event);
void on_contact_lost(container_supervisor_pointer self);

/// Takes up what the store knew when the node started.
void restore(container_supervisor_pointer self);

/// Ends what no record knows: nobody could ever end it otherwise.
void end_strays(container_supervisor_pointer self);

// Logs of instances, and of those that are gone.

/// A part of the log of an instance, or of the one that was kept of it. Errors:
/// unknown_task.
caf::result<log_excerpt> read_log(container_supervisor_pointer self,
                                  const log_query& query);

/// Which logs are kept on this node.
caf::result<kept_logs> list_logs(container_supervisor_pointer self,
                                 const kept_logs_query& query);

/// With what the log of an ended instance is kept.
kept_log about_log_of(const supervised_instance& x);

} // namespace roscell
