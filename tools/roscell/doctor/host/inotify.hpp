#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace roscell::cli {

/// How many inotify instances one user may have, and has.
struct inotify_readings {
  int64_t most = -1; ///< Negative: not known.
  int64_t used = 0;  ///< In the processes that may be looked at.
};

inotify_readings read_inotify(const std::string& proc, uid_t user);

finding judge_inotify(const inotify_readings& seen);

findings check_inotify(const checked_host& host);

} // namespace roscell::cli
