#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/event.hpp"

#include <cstdint>
#include <filesystem>
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

/// Numbers for events that no earlier run of this node has given, whatever
/// ended it: a file says up to which number they are set aside. It is written
/// in place, so that it needs no room on a disk that has none. Blocks on the
/// disk.
class event_numbers {
public:
  explicit event_numbers(std::filesystem::path file);

  /// Up to this number they were set aside when this run began: its own are
  /// above. 0 where nothing is known.
  uint64_t before() const {
    return before_;
  }

  /// Up to this number they are set aside now.
  uint64_t end() const {
    return end_;
  }

  /// Sets more aside if few are left above `used`.
  std::optional<edge_error> set_aside(uint64_t used);

  /// The run is over: the next one goes on right behind `used`.
  std::optional<edge_error> finish(uint64_t used);

private:
  std::optional<edge_error> write(uint64_t end);

  std::filesystem::path file_;
  uint64_t before_ = 0;
  uint64_t end_ = 0;
};

} // namespace roscell
