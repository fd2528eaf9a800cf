#pragma once

#include <string>

namespace roscell::engine {

/// Writes one line to stderr, which becomes the instance's log, in one piece.
/// Names from outside may hold any byte; control characters, which would forge
/// or split lines of the log, are replaced. May be called from any thread.
void log_line(std::string line);

} // namespace roscell::engine
