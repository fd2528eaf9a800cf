#pragma once

#include <sys/types.h>

/// The processes that a process has started, and those that these have.
namespace roscell::shim {

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
