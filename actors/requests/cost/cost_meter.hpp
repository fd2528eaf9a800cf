#pragma once

#include "actors/requests/cost/cost_ring.hpp"

#include <functional>
#include <mutex>
#include <vector>

namespace roscell {

/// The ring of a node, and what it is told by. Any thread may mark and ask.
class cost_meter {
public:
  using reader = std::function<cost_reading()>;

  explicit cost_meter(reader read = [] { return cost_reading{}; });

  void mark(cost_ring::time_point now);

  /// What it has cost until now.
  std::vector<cost_window> windows(cost_ring::time_point now);

private:
  reader read_;
  /// Held while reading: two readings must not be told in the wrong order.
  std::mutex mutex_;
  cost_ring ring_;
};

} // namespace roscell
