#pragma once

#include "tools/instance_shim/options.hpp"

namespace roscell::shim {

/// Has the kernel look for others first when memory is short: without the shim
/// nobody keeps the fence. As far as the shim may.
void be_the_last_to_go();

/// Makes the calling process an ordinary one among those of the host, whatever
/// it has from the node but its processors: its scheduling, nice value, place
/// in the queues of disks, umask, core dumps, what it may raise of these, and
/// the capabilities that it would hand on. It is more easily ended for memory
/// than the shim.
void become_ordinary();

/// Then the scheduling that it is to have. False with errno set.
bool take_scheduling(const scheduling& request);

} // namespace roscell::shim
