#pragma once

#include "tools/instance_shim/cgroups.hpp"
#include "tools/instance_shim/options.hpp"

#include <signal.h>
#include <sys/types.h>

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

/// Starts the command in a process group of its own and in its cgroup, with the
/// attributes of an ordinary program. It dies with the shim,
/// reads from /dev/null, unless somebody is attached to it, and writes to
/// `output`, or where the shim does if that is negative. If it cannot be
/// started, it writes the reason and ends with code 127. Returns the process
/// id, or -1 with errno set.
pid_t start_child(const options& o, int output);

/// Reaps all children that have ended. Returns whether `child` was among
/// them; then `wait_status` is set, and its process group has been killed
/// unless it is spared.
bool reap(pid_t child, int& wait_status, bool spares_group);

/// Whether anybody is left of all that the command has started.
bool has_children();

/// Kills all who are in the cgroup, and all descendants of the shim, at once.
/// Waits for nothing: to be repeated while one of them ends.
void kill_all(const cgroup_list& cgroups);

/// Kills all that are left, also those that have moved to another process
/// group or another cgroup. Waits at most a moment for their end; `signals` is
/// the shim's descriptor for SIGCHLD.
void kill_leftovers(const cgroup_list& cgroups, int signals);

// The processes that a process has started, and those that these have.

using visitor = void (*)(pid_t process, void* context);

/// Calls it for each descendant, the deepest first: the children of one that
/// has ended have another parent. Returns whether there were any, those that
/// have ended and are not reaped included.
bool visit_descendants(pid_t process, visitor visit, void* context);

/// Whether a process does something else with a signal than to end of it, or
/// to ignore it: it catches it, or takes it from where blocked ones wait.
bool takes_signal(pid_t process, int number);

/// Whether a signal does nothing to it, as SIGINT to what a shell has started
/// in its background.
bool ignores_signal(pid_t process, int number);

} // namespace roscell::shim
