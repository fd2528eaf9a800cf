#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// A program to be started.
struct program {
  std::filesystem::path path;
  std::vector<std::string> arguments; ///< Without the program itself.
  std::map<std::string, std::string> environment; ///< All that it will see.
};

/// A child of ours.
struct spawned_program {
  process_identity identity;
  unique_fd pidfd;
};

/// Starts a program with no descriptor of ours but its standard streams, no
/// blocked signal, and /dev/null as input. Waits, `limit` at most, until the
/// program has closed its output: having written nothing it has started, and
/// what it has written is why it fails.
///
/// Errors: engine_failed, when it cannot be started, says why it fails, or
/// passes the limit; it has ended then.
edge_result<spawned_program> spawn_program(const program& what,
                                           std::chrono::milliseconds limit);

/// Runs a program to its end, started as above, and gives what it has written
/// to its standard output and error, `max_bytes` at most. Waits.
///
/// Errors: engine_failed (as above; its words say why), timeout; it is killed
/// then.
edge_result<std::string> run_program(const program& what,
                                     std::chrono::milliseconds limit,
                                     size_t max_bytes);

} // namespace roscell
