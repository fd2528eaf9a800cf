#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <sys/types.h>

#include <cstdint>
#include <string>

/// What the kernel gives: time, files, and who follows them.
namespace roscell::cli {

/// What the kernel knows of the clock that people and messages go by.
struct clock_readings {
  bool reported = false;
  bool synchronised = false;
  int64_t most_error_us = 0; ///< How wrong it may be.
};

clock_readings read_clock();

finding judge_clock(const clock_readings& clock);

findings check_clock(const checked_host& host);

/// How many inotify instances one user may have, and has.
struct inotify_readings {
  int64_t most = -1; ///< Negative: not known.
  int64_t used = 0;  ///< In the processes that may be looked at.
};

inotify_readings read_inotify(const std::string& proc, uid_t user);

finding judge_inotify(const inotify_readings& seen);

findings check_inotify(const checked_host& host);

/// @param most that a process may have open; a node raises its own to that.
finding judge_descriptors(uint64_t most);

findings check_descriptors(const checked_host& host);

} // namespace roscell::cli
