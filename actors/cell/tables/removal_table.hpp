#pragma once

#include "actors/core/backoff.hpp"

#include <chrono>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// An instance that a node did not remove in time.
struct overdue_removal {
  std::string node;
  std::string task;
  std::string instance;
};

/// What nodes are to be asked once more to remove. Pure; told the time. A node
/// that registers anew is told what to stop, so it is forgotten here.
class removal_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// The node did not remove it, so it is asked again after a pause that
  /// grows from time to time.
  void add(const overdue_removal& what, time_point now);

  /// Those whose pause is over; they are not due again before `add`.
  std::vector<overdue_removal> take_due(time_point now);

  /// When the next pause is over; time_point::max() if none is waited for.
  time_point next_due() const;

  /// Whether it is asked for once more.
  bool has(const std::string& node, const std::string& instance) const {
    return entries_.count({node, instance}) > 0;
  }

  /// The node has removed it.
  void settle(const overdue_removal& what);
  void forget_node(const std::string& node);

  size_t size() const {
    return entries_.size();
  }

private:
  struct entry {
    std::string task;
    time_point due;
    backoff pause;
  };

  /// By node and instance.
  std::map<std::pair<std::string, std::string>, entry> entries_;
};

} // namespace roscell
