#pragma once

#include "client/value_text.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

/// Foreign text as a terminal shows it, and the option values that carry a
/// unit.
namespace roscell::cli {

/// Bytes of `text` that are safe in one line of a terminal: control characters
/// and what is not UTF-8 are shown as '?'.
std::string printable(std::string_view text);

/// Columns that `text` takes on a terminal: two for a wide character, as those
/// of Chinese and most emoji, none for an accent that is put above another.
size_t display_width(std::string_view text);

/// Its characters, that is its code points.
size_t letters_in(std::string_view text);

/// The first character of a text that is not empty, with those that are put
/// above it.
std::string_view first_letter(std::string_view text);

/// What of `text` `width` columns have room for, with an ellipsis at the end
/// when something is cut off.
std::string shortened(std::string_view text, size_t width);

/// Bytes of "1048576", "64KiB", "1MiB" or "2GiB". Throws
/// std::invalid_argument for anything else.
uint64_t parse_bytes(std::string_view text);

/// Milliseconds of "30", "2.5" (seconds), "500ms", "2m" or "1h". Throws
/// std::invalid_argument for anything else, for zero, and for more than a day.
std::chrono::milliseconds parse_duration(std::string_view text);

/// Seconds of "90s", "5m", "2h" or "7d", at most a hundred years. Throws
/// std::invalid_argument for anything else.
std::chrono::seconds parse_span(std::string_view text);

} // namespace roscell::cli
