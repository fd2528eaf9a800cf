#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// INTERNAL to this folder: small files of /proc and /sys.
namespace roscell {

/// The first `max_bytes` of a file, none if it cannot be read.
std::optional<std::string> read_file(const std::string& path,
                                     std::size_t max_bytes = 65536);

/// The next word of `text`, which loses it; empty at the end. Words are
/// separated by blanks, tabs and newlines.
std::string_view take_word(std::string_view& text);

/// The next line of `text`, which loses it.
std::string_view take_line(std::string_view& text);

/// A whole number that is all of `word`, none otherwise.
std::optional<long long> to_number(std::string_view word);

/// A decimal fraction of at least 0 that is all of `word`, none otherwise.
std::optional<double> to_fraction(std::string_view word);

} // namespace roscell
