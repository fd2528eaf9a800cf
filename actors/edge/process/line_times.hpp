#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace roscell {

/// What stands at `offset` in a log, and after it up to the next note, was
/// written then. A shim's file of times is an array of these.
struct time_note {
  int64_t offset = 0;
  int64_t unix_ms = 0;
};

/// When each line of `bytes`, or the rest of one, was written: the notes are in
/// the order of their offsets, and `from` is the offset of the first byte. 0
/// where no note tells.
std::vector<int64_t> line_times(std::string_view bytes, int64_t from,
                                const std::vector<time_note>& notes);

/// More lines of which each has its time make no part of a log: with a time
/// each, the shortest ones would not fit into an answer.
constexpr int64_t most_timed_lines = 8192;

/// How many bytes of a text its first so many lines have.
size_t bytes_of_lines(std::string_view text, int64_t lines);

/// Where its last so many lines begin. A newline at the very end ends the last
/// line and begins no other.
size_t begin_of_last_lines(std::string_view text, int64_t lines);

} // namespace roscell
