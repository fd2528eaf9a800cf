#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

namespace roscell::shim {

/// Who the command is to be, whatever the shim is.
struct identity {
  /// The kernel takes more, but a user of a host is in fewer.
  static constexpr std::size_t most_groups = 256;

  bool has_user = false; ///< Else it stays the shim's.
  uid_t user = 0;
  gid_t group = 0;
  gid_t groups[most_groups] = {};
  std::size_t group_count = 0;
  bool has_capabilities = false;  ///< Else they stay the shim's.
  std::uint64_t capabilities = 0; ///< By the kernel's numbers.
};

/// Reads "UID:GID[,GROUP...]". Returns whether it is one.
bool read_user(const char* text, identity& result);

/// Reads a hexadecimal number. Returns whether it is one.
bool read_capabilities(const char* text, identity& result);

/// Makes the calling process that. It keeps those of the capabilities that it
/// has, hands them on to what it runs, and gains none by running anything.
/// Clears what a process is to get when its parent ends. Returns false with
/// errno set.
bool take_identity(const identity& wanted);

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

/// With what standard streams a command runs that somebody is attached to:
/// with the shim's own, of which a terminal becomes its controlling one.
enum class attachment { none, pipes, terminal };

/// Of a shim with such a command: all of it ends when the other end is closed.
constexpr int lifeline_place = 3;

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
  attachment attached = attachment::none; ///< Then there are no records.
  /// Unix socket that is the lifeline; null: descriptor 3 is.
  const char* lifeline = nullptr;
  cgroup_list cgroups;      ///< That the command is put into.
  scheduling request;       ///< Of the command.
  identity who;             ///< that the command is to be
  char** command = nullptr; ///< the command and its arguments
};

/// Returns false, after a line on stderr, when the arguments make no sense.
bool read_options(int argc, char** argv, options& result);

} // namespace roscell::shim
