#pragma once

#include "messages/event.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// How events stand in a file: each on a line of its own, its number before its
/// JSON, so that a reader that looks for a number need not read the rest.
namespace roscell {

/// With the newline, and never longer than what is read back: particulars that
/// are too long are left out, with their size, and a long subject is cut. Bytes
/// that are no UTF-8 are replaced.
std::string line_of(const event& x);

/// The number that a line begins with; none: it is not such a line.
std::optional<uint64_t> number_of(std::string_view line);

/// None for anything that `line_of` has not written: a line that a loss of
/// power has torn, or that somebody has changed.
std::optional<event> event_of(std::string_view line);

} // namespace roscell
