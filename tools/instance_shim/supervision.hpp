#pragma once

#include "tools/instance_shim/options.hpp"

#include <sys/types.h>

#include <cstdint>

namespace roscell::shim {

/// The moment at which the command ends unless it is moved on before. It stands
/// in a file, in milliseconds of CLOCK_BOOTTIME, as one 64-bit number in the
/// machine's own order. That clock goes on while the host sleeps, and nobody
/// can set it. Whoever moves the moment on writes the file and wakes nobody:
/// the file is read again when the moment that was read last has come.
class fence {
public:
  fence() = default;

  ~fence();

  fence(const fence&) = delete;
  fence& operator=(const fence&) = delete;

  /// Holds the fence in the file of this path, which must stay valid. Returns
  /// false with errno set where none can be held, or its moment has passed.
  bool hold(const char* path);

  /// Readable when there is something to look at; negative: there is no fence.
  int timer() const {
    return timer_;
  }

  /// Returns whether the moment has passed. A file that cannot be read, or is
  /// too short, moves nothing on.
  bool has_passed();

private:
  bool wait_until(std::int64_t boot_ms) const;

  const char* path_ = nullptr;
  int timer_ = -1;
};

class log_files;

/// One command that runs, and what the shim hears of it.
struct supervision {
  pid_t child = -1;
  int signals = -1;     ///< The shim's descriptor for signals.
  int stop_signal = 15; ///< What asks the command to end.
  int output = -1;      ///< Of the command, not blocking; negative: not ours.
  log_files* log = nullptr; ///< Takes the output; null: it is not ours.
  int lifeline = -1; ///< All are killed when its end is seen; negative: none.
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
