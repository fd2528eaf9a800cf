#pragma once

#include "tools/roscell/doctor/examined_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace roscell::cli {

/// How many inotify instances one user may have, and has.
struct inotify_facts {
  int64_t most = -1; ///< Negative: not known.
  int64_t used = 0;  ///< In the processes that may be looked at.
};

inotify_facts look_at_inotify(const std::string& proc, uid_t user);

finding judge_inotify(const inotify_facts& seen);

findings examine_inotify(const examined_host& host);

} // namespace roscell::cli
