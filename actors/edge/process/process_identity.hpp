#pragma once

#include "actors/edge/io/unique_fd.hpp"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// The header of glibc 2.36, Debian 12's, forgets to say that these are C
// functions (glibc bug 29697).
extern "C" {
#include <sys/pidfd.h>
}

namespace roscell {

/// Tells a process from all others that have had, or will have, its number.
struct process_identity {
  pid_t pid = 0;
  uint64_t start_time = 0; ///< Clock ticks since boot (proc(5), field 22).
};

/// "<pid>:<start time>", the id of a process as a container.
std::string to_container(const process_identity& process);

/// The opposite; nothing for any other text.
std::optional<process_identity> process_of(std::string_view container);

/// Who has the number now.
/// @param proc where proc(5) is.
std::optional<process_identity>
identify(pid_t pid, const std::filesystem::path& proc = "/proc");

/// A descriptor for the process that can be polled for its end and signalled
/// without mistaking another process for it. Empty if it is gone. One of its
/// arguments must end with `marker`: after a reboot, number and start time may
/// be those of another process.
unique_fd open_process(const process_identity& process,
                       const std::string& marker = {});

/// Whether the process behind the descriptor has ended.
bool has_ended(int pidfd);

/// Takes an ended child out of the process table, so that it does not stay
/// there as a zombie. Returns its exit code, 128 + n after signal n; nothing
/// for the child of another process.
std::optional<int> reap(int pidfd);

/// The process of the shim that keeps its records in `dir`, as the file `pid`
/// says.
std::optional<process_identity>
read_pid_record(const std::filesystem::path& dir);

/// The file in which a shim writes how its command has ended.
constexpr const char* exit_record_name = "exit";

/// How the command of a shim has ended.
struct recorded_end {
  int exit_code = -1;          ///< 128 + n after signal n.
  bool terminated = false;     ///< The shim had been told to end it.
  int64_t memory_kills = 0;    ///< Processes of it that were ended for memory.
  double most_memory_mib = -1; ///< That it ever had; negative: not known.
};

/// What that file says, in its folder. Nothing as long as it has not
/// ended in order.
std::optional<recorded_end> read_exit_record(const std::filesystem::path& dir);

/// Kills every process of this host that was started with the environment
/// variable `name` of this value, and waits a moment for their end: a killed
/// one may have started another one meanwhile, so it looks again until there is
/// none, nor one that is about to become another program. Finds what has a
/// session and a parent of its own, but not what has dropped the variable.
/// Returns how many it has killed. Blocks for a second at most.
int kill_marked_processes(const std::string& name, const std::string& value);

} // namespace roscell
