#pragma once

#include "client/known_cell.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell::cli::top {

/// What is wrong in a cell, a sentence each, what matters most first: nodes
/// that are away, tasks that do not run, and instances with their reasons.
std::vector<std::string> problems_of(const known_cell& known,
                                     int64_t now_unix_ms);

} // namespace roscell::cli::top
