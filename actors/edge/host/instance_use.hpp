#pragma once

#include "messages/inside/agent.hpp"

#include <sys/types.h>

#include <set>
#include <string>
#include <vector>

namespace roscell {

/// What a set of processes uses.
struct process_usage {
  double cpu_seconds = 0; ///< User and system time, waited-for children too.
  double rss_mib = 0;     ///< Resident; pages they share count more than once.
  int processes = 0;
  std::set<pid_t> pids;
};

/// By what the processes of our own instances are known.
struct own_processes {
  std::set<pid_t> sessions;         ///< Session leaders.
  std::set<std::string> containers; ///< An engine's ids: 64 hex digits.

  bool empty() const {
    return sessions.empty() && containers.empty();
  }
};

/// The use of all processes of these sessions and in these containers, from one
/// scan of /proc, below `root`. A container's processes are those whose cgroup
/// is named after it, as every engine does that may make cgroups. The purpose
/// is to take our own instances' use from the host's; `cpu_seconds` falls when
/// an instance ends.
process_usage usage_of(const own_processes& own, const std::string& root = {});

/// What each of these instances takes of the host: from its cgroup where it has
/// one of its own, else from its processes. Of containers whose engine makes
/// none nothing is known. Instances of which nothing is known are left out.
/// @param root where /proc is, for tests.
std::vector<measured_use>
uses_of(const std::vector<measured_instance>& instances,
        const std::string& root = {});

} // namespace roscell
