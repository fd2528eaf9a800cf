#pragma once

#include <sys/types.h>

namespace roscell::shim {

class log_files;

/// Writes `pid` into the folder: the shim's process id and start time (field
/// 22 of /proc/PID/stat, clock ticks since boot) and the child's process id,
/// in one line. The file appears complete or not at all.
bool write_pid(int directory, pid_t child);

/// The record of how the child ended. Its room on the disk is taken when it is
/// made, so that it can be written even when the disk is full by then.
class exit_record {
public:
  /// Removes the record of an earlier run.
  explicit exit_record(int directory);

  ~exit_record();

  exit_record(const exit_record&) = delete;
  exit_record& operator=(const exit_record&) = delete;

  /// Writes `exit` as JSON, {"code", "signal", "at_unix_ms"}, of which one of
  /// the first two is null, and "fenced": true where its fence has ended it.
  /// `wait_status` is that of waitpid(2). Returns true when the record would
  /// survive a loss of power.
  bool write(int wait_status, bool fenced, log_files& log);

private:
  bool store(const char* text, int size);

  const int directory_;
  int file_ = -1;
};

} // namespace roscell::shim
