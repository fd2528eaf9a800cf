#pragma once

#include "tools/instance_shim/fence.hpp"
#include "tools/instance_shim/options.hpp"

#include <sys/types.h>

namespace roscell::shim {

class log_files;

/// One command that runs, and what the shim hears of it.
struct supervision {
  pid_t child = -1;
  int signals = -1;     ///< The shim's descriptor for signals.
  int stop_signal = 15; ///< What asks the command to end.
  int output = -1;      ///< Of the command, not blocking; negative: not ours.
  log_files* log = nullptr; ///< Takes the output; null: it is not ours.
  fence* limit = nullptr;
  cgroup_list cgroups;     ///< Of the command.
  bool ended = false;      ///< The child has.
  int wait_status = 0;     ///< Of the child, once it has ended.
  bool forced = false;     ///< All are to be killed, by SIGQUIT.
  bool fenced = false;     ///< It was killed because its fence had passed.
  bool terminated = false; ///< The shim was asked to end it, by SIGTERM.
};

/// The shim's descriptor for the signals that it takes, or -1 with errno set.
int open_signals();

/// Passes signals on, moves output into the log and keeps the fence until the
/// child has ended and no descendant of it is left. What is left of a child
/// that was asked to end, as behind a shell that passes nothing on, has been
/// asked as well and is waited for until SIGQUIT comes; after any other end it
/// is killed.
void supervise(supervision& x);

} // namespace roscell::shim
