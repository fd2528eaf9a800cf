#pragma once

#include "tools/instance_shim/options.hpp"

#include <sys/types.h>

namespace roscell::shim {

/// What was read of the command's cgroup.
struct memory_story {
  long long kills = 0; ///< Processes that were ended for memory.
  long long most = -1; ///< Bytes that it ever had; negative: not known.
};

/// As fork(2), but the child is in the cgroup already, where the kernel can do
/// that: of version 2, without the wait for all other processors that a move
/// costs. `inside` says whether it is.
pid_t fork_into(const cgroup_list& folders, bool& inside);

/// Moves the calling process, which has one thread, into them. Complains in the
/// log and goes on where it may not.
void enter(const cgroup_list& folders);

/// Kills all who are there; those of version 1 are frozen meanwhile, so that
/// none of them starts another one. Returns whether anybody was. Waits for
/// nothing.
bool kill_members(const cgroup_list& folders);

memory_story read_memory(const cgroup_list& folders);

/// The same of the cgroup that this process is in, in a container: the engine
/// shows it at the usual place. Nothing where no memory is bounded there, for
/// that may be the whole host.
memory_story read_own_memory();

} // namespace roscell::shim
