#pragma once

#include <cstdint>

namespace roscell::shim {

/// The command line of the shim.
struct options {
  const char* directory = nullptr;   ///< where the records and the log go
  std::uint64_t log_bytes = 0;       ///< most bytes of log that are kept
  const char* working_dir = nullptr; ///< of the command; null: the shim's own
  int stop_signal = 15;              ///< what asks the command to end
  char** command = nullptr;          ///< the command and its arguments
};

/// Returns false, after a line on stderr, when the arguments make no sense.
bool read_options(int argc, char** argv, options& result);

} // namespace roscell::shim
