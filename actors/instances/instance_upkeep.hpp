#pragma once

#include "actors/instances/instance_removal.hpp"

#include <caf/system_messages.hpp>

#include <string>

/// INTERNAL to the container supervisor: the actors of its instances and its
/// runtime, from their start over their deaths to their successors.
namespace roscell {

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

} // namespace roscell
