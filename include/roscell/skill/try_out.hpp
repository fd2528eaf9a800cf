#pragma once

#include "roscell/skill/executor.hpp"

#include <string>
#include <vector>

namespace roscell::engine {

/// For tests of a skill: what an executor makes of the frames that lie in a
/// file or folder, read as a node's skill reads an input of protocol `file` and
/// `data_type`: of a text type each line is a frame, else each file. Calls
/// `process` for each frame and then `release`, all in the calling thread, and
/// returns what was emitted, in order. A result has the output's number in
/// `port`; what the executor left open is left so.
///
/// Throws start_error when `path` cannot be read, and what the executor throws.
std::vector<frame> try_out(executor& subject, const std::string& path,
                           const std::string& data_type);

} // namespace roscell::engine
