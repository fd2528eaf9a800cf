#pragma once

#include "tools/instance_shim/identity.hpp"

#include <cstdint>

namespace roscell::shim {

/// How the command is scheduled; without a request as any program.
struct scheduling {
  int policy = 0; ///< As of sched(7): SCHED_OTHER.
  int priority = 0;
  int nice = 0;
};

/// The folders of one cgroup: one in each hierarchy.
struct cgroup_list {
  static constexpr int most = 8;

  const char* at[most] = {};
  int count = 0;
};

/// The command line of the shim.
struct options {
  /// Where the records and the log go; null: nowhere, and the output stays the
  /// shim's own.
  const char* directory = nullptr;
  std::uint64_t log_bytes = 0;     ///< most bytes of log that are kept
  const char* fence = nullptr;     ///< file with the fence; null: there is none
  const char* exit_file = nullptr; ///< takes the record where nothing else goes
  const char* working_dir = nullptr; ///< of the command; null: the shim's own
  int stop_signal = 15;              ///< what asks the command to end
  cgroup_list cgroups;               ///< That the command is put into.
  scheduling request;                ///< Of the command.
  identity who;                      ///< that the command is to be
  char** command = nullptr;          ///< the command and its arguments
};

/// Returns false, after a line on stderr, when the arguments make no sense.
bool read_options(int argc, char** argv, options& result);

} // namespace roscell::shim
