#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace roscell::embedding {

/// The log of one instance in memory: the last lines, within a bound of bytes.
/// A place in it is a count of all bytes that were ever logged. May be used
/// from any thread.
class line_ring {
public:
  /// A part of it.
  struct excerpt {
    std::string text;
    std::int64_t next_offset = 0;
    std::vector<std::int64_t> times_unix_ms; ///< One a line.
    bool is_whole = true; ///< Nothing has been logged behind it.
  };

  /// `on_line` is called after each line, from the thread that logs it.
  line_ring(std::size_t most_bytes, std::function<void()> on_line);

  /// Adds one line; control characters in it are replaced.
  void add(std::string line, std::int64_t now_unix_ms);

  /// From `offset` on; of an offset that is dropped already, from the first
  /// line that is still there.
  excerpt read_from(std::int64_t offset) const;

  excerpt read_tail(std::size_t lines) const;

private:
  struct line {
    std::string text; ///< With its line feed.
    std::int64_t time_unix_ms;
  };

  excerpt read(std::size_t first_line) const;

  const std::size_t most_bytes_;
  const std::function<void()> on_line_;
  mutable std::mutex mutex_; // Guards what follows.
  std::deque<line> lines_;
  std::size_t bytes_ = 0;
  std::int64_t dropped_bytes_ = 0;
};

} // namespace roscell::embedding
