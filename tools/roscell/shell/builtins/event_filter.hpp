#pragma once

#include "messages/event.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// Which events somebody wants to see. Nothing named: all of them.
struct event_filter {
  /// Events, or with a "*" at the end what they begin with.
  std::vector<std::string> kinds;
  /// Nodes, tasks, steps or instances that an event is about.
  std::vector<std::string> subjects;

  bool takes(const event& e) const;

  /// "node_* of arm-1"
  std::string words() const;
};

} // namespace roscell::cli
