#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace roscell::cli {

/// What the program ends with. The numbers are part of its interface.
enum exit_code : int {
  exit_done = 0,
  exit_refused = 1,     ///< The node refused; the JSON error is on stdout.
  exit_usage = 2,       ///< The command line or a file it names is wrong.
  exit_unreachable = 3, ///< No node answered.
};

/// Ends a command: `what()` is printed as an error, the hint below it.
class command_error : public std::runtime_error {
public:
  command_error(exit_code code, const std::string& message,
                std::string hint = {})
      : std::runtime_error{message}, code{code}, hint{std::move(hint)} {}

  exit_code code;
  std::string hint; ///< What to do about it; may be empty.
};

} // namespace roscell::cli
