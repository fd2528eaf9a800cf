#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace roscell::cli {

/// What came of a command.
struct command_result {
  /// As by `exit`; 127: it could not be started, 124: it was ended because it
  /// took too long.
  int code = 0;
  std::string said; ///< Standard output and error, of a bounded size.
};

constexpr int command_not_found = 127;
constexpr int command_took_too_long = 124;

/// Runs a program of $PATH, without a shell and without input.
command_result run_bounded(const std::vector<std::string>& words,
                           std::chrono::milliseconds limit);

} // namespace roscell::cli
