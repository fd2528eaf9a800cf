#pragma once

#include <chrono>
#include <string_view>

namespace roscell::cli {

/// Seconds of "90s", "5m", "2h" or "7d", at most a hundred years. Throws
/// std::invalid_argument for anything else.
std::chrono::seconds parse_span(std::string_view text);

} // namespace roscell::cli
