#pragma once

#include "skills/ros2/graph.hpp"

#include <cstdint>
#include <map>

namespace roscell::ros2 {

/// Counts the messages that a reader never saw, by the numbers that every DDS
/// writer gives its messages.
class gap_counter {
public:
  /// Message `number` of `writer` was read. Returns how many of the same writer
  /// are missing before it; none before the first.
  std::uint64_t add(const guid& writer, std::uint64_t number);

  /// The highest number of that writer's messages that were read; 0: none was.
  std::uint64_t last(const guid& writer) const;

private:
  std::map<guid, std::uint64_t> last_;
};

} // namespace roscell::ros2
