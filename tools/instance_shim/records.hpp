#pragma once

#include "tools/instance_shim/cgroups.hpp"

#include <sys/types.h>

namespace roscell::shim {

class log_files;

/// Writes `pid` into the folder: the shim's process id and start time (field
/// 22 of /proc/PID/stat, clock ticks since boot) and the child's process id. It
/// is where a link leads, which appears complete or not at all and takes no
/// block of the disk: a program may be started again each second.
bool write_pid(int directory, pid_t child);

/// How a child has ended.
struct child_end {
  int wait_status = 0;     ///< As of waitpid(2).
  bool fenced = false;     ///< By its fence.
  bool terminated = false; ///< After the shim was asked to end it.
  memory_story memory;     ///< Of its cgroup, if it had one.
};

/// The record of how the child ended. Its room on the disk is taken when it is
/// made, so that it can be written even when the disk is full by then.
class exit_record {
public:
  /// As `exit` in that folder, where it appears complete or not at all. Removes
  /// the record of an earlier run.
  explicit exit_record(int directory);

  /// Into an empty file that is there, which no other can take the place of:
  /// that of a host, in a container.
  explicit exit_record(const char* file);

  ~exit_record();

  exit_record(const exit_record&) = delete;
  exit_record& operator=(const exit_record&) = delete;

  bool is_open() const {
    return file_ >= 0;
  }

  /// Writes JSON, {"code", "signal", "at_unix_ms"}, of which one of the first
  /// two is null, "fenced": true where its fence has ended it, and
  /// "terminated": true where the shim was asked to, and of its cgroup
  /// "memory_kills" and "most_memory_bytes" where they are known. A null log is
  /// nobody's. Returns true when the record would survive a loss of power.
  bool write(const child_end& end, log_files* log);

private:
  bool store(const char* text, int size);

  const int directory_ = -1; ///< Negative: it is written in its place.
  int file_ = -1;
};

} // namespace roscell::shim
