#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roscell::engine {

/// Cuts a stream of bytes into lines. Holds at most one line of `max_bytes`
/// and the last chunk; a longer line is left out, but counted.
class line_splitter {
public:
  explicit line_splitter(std::size_t max_bytes) : max_bytes_(max_bytes) {
    // nop
  }

  /// Adds bytes. To be called when `next` has returned nothing.
  void feed(std::string_view bytes);

  /// The next complete line, without its newline.
  std::optional<std::string> next();

  /// What follows the last newline, if anything, as a line of its own.
  std::optional<std::string> rest();

  /// Whether there are bytes after the last newline.
  bool has_rest() const noexcept {
    return position_ < buffer_.size() || skipping_;
  }

  /// Number of the line that was returned last, counted from 1.
  std::uint64_t line_number() const noexcept {
    return lines_;
  }

  /// Lines that were too long.
  std::uint64_t too_long() const noexcept {
    return too_long_;
  }

private:
  bool accept(std::size_t size);

  const std::size_t max_bytes_;
  std::string buffer_;
  std::size_t position_ = 0;
  std::size_t searched_ = 0;
  std::uint64_t lines_ = 0;
  std::uint64_t too_long_ = 0;
  bool skipping_ = false;
};

} // namespace roscell::engine
