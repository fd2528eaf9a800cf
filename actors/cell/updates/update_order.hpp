#pragma once

#include "messages/instance.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// In which order the steps of an update are replaced. Pure.
namespace roscell {

/// A step that ends, starts, or both.
struct replaced_step {
  std::optional<instance_spec> old;   ///< What runs; none: nothing to end.
  std::optional<instance_spec> fresh; ///< What is to run; none: nothing.
  std::string old_node;
  std::string fresh_node;
  /// There is no room for the new one before others on its node have ended.
  bool needs_room = false;
  size_t rank = 0; ///< In the data flow of the new request; upstream first.
};

/// Positions of steps, wave by wave. In each all old ones end before the first
/// new one starts. One wave has one step, unless a new one would
/// write a topic or file that another's old one writes, use its device, or
/// needs its room: so a topic has one writer at any time. Upstream waves come
/// first, those that only end the last.
std::vector<std::vector<size_t>>
update_waves(const std::vector<replaced_step>& steps);

} // namespace roscell
