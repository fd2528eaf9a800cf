#pragma once

#include <set>
#include <string>

#include <sys/types.h>

namespace roscell {

/// What a set of processes uses.
struct process_usage {
  double cpu_seconds = 0; ///< User and system time, waited-for children too.
  double rss_mib = 0;     ///< Resident; pages they share count more than once.
  int processes = 0;
  std::set<pid_t> pids;
};

/// The use of all processes whose session leader is in `sessions`, from one
/// scan of /proc, below `root`. Its purpose is to take our own instances' use
/// from the host's; `cpu_seconds` falls when a session ends.
process_usage usage_of_sessions(const std::set<pid_t>& sessions,
                                const std::string& root = {});

} // namespace roscell
