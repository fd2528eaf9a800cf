#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace roscell {

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
