#pragma once

#include "tools/instance_shim/cgroups.hpp"
#include "tools/instance_shim/options.hpp"

#include <signal.h>
#include <sys/types.h>

namespace roscell::shim {

/// Starts the command in a process group of its own and in its cgroup, with the
/// attributes of an ordinary program. It dies with the shim,
/// reads from /dev/null, and writes to `output`, or where the shim does if that
/// is negative. If it cannot be started, it writes the reason and ends with
/// code 127. Returns the process id, or -1 with errno set.
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

} // namespace roscell::shim
