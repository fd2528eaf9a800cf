#pragma once

#include "test/site/watch/task_view.hpp"

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace roscell::test {

/// Watches the invariants of tasks while there are faults. What must never
/// happen goes to the site's violations.
class task_watch {
public:
  using duration = std::chrono::milliseconds;

  explicit task_watch(site& place) : place_(place) {}

  void look();

  /// Longest time that a step ran on two nodes of its cell.
  duration longest_double() const {
    return doubles_.longest;
  }

  /// Longest time that a program ran for no task on a node of its cell.
  duration longest_stray() const {
    return strays_.longest;
  }

private:
  using moment = std::chrono::steady_clock::time_point;
  using key = std::tuple<size_t, std::string, std::string>;

  /// Since when what holds, and for how long something held at most.
  struct span_table {
    std::map<key, moment> since;
    duration longest{0};

    void update(const std::set<key>& present, moment now);
  };

  /// What a coordinator believed when it was looked at last.
  struct snapshot {
    unsigned life = 0;
    std::set<std::string> running;                        ///< Tasks.
    std::set<std::pair<std::string, std::string>> placed; ///< Task, node.
  };

  void check_programs(const site_party& coordinator,
                      const std::vector<task_view>& tasks,
                      std::set<key>& doubled, std::set<key>& stray) const;
  void check_ends(const site_party& coordinator, const snapshot& now);
  void check_events();
  void check_departure(const site_event& event);
  void check_moved_step(const site_event& event);
  void check_loss(const std::string& old, const std::string& from);
  bool is_healed(const site_event& event) const;
  bool may_still_act(const site_request& x, size_t coordinator) const;
  bool is_wanted(instance_policy policy, size_t coordinator) const;

  site& place_;
  span_table doubles_; ///< By cell, task and step.
  span_table strays_;  ///< By machine and instance.
  std::map<size_t, snapshot> seen_;
  size_t events_seen_ = 0;
  std::set<size_t> answered_; ///< Requests that were at the last look.
  std::set<key> ended_transfers_;
};

} // namespace roscell::test
