#pragma once

#include "messages/instance.hpp"

#include <string>

namespace roscell {

/// Puts the parts of one log together, each line behind its time, where the
/// parts tell times: "2026-11-22T17:01:02.345Z a line". A line that comes in
/// several parts gets its time once, one whose time is not known a "-".
class timed_log {
public:
  /// What is to be shown of the next part, byte by byte as it was logged.
  std::string add(const log_excerpt& part);

private:
  bool in_line_ = false; ///< The part before has ended within a line.
};

} // namespace roscell
