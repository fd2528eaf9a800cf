#pragma once

#include "test/site/site.hpp"
#include "test/site/watch/task_watch.hpp"

#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace roscell::test {

/// What is not as it shall be once things have calmed down, for people; empty
/// if all is well.
std::string complaint(const site& place);

/// Names the registrations that a registry has taken though it had a newer one
/// of the same node; empty if there is none.
std::string old_registrations(const site& place);

/// Ends all faults, lets time pass until there is no complaint, and looks
/// whether it stays so. Gives what is left of it.
std::string calm_down(site& place);

/// Has every cell let go the nodes that do not come back: what they have left
/// behind must not stand in the way. Gives what does.
std::string release_retired(site& place);

/// Watches the invariants while there are faults.
class site_watch {
public:
  using duration = std::chrono::milliseconds;

  explicit site_watch(site& place) : place_(place), tasks_(place) {}

  /// Lets time pass, looking every so often.
  void live(duration span);
  void look();

  /// Longest time that a registry showed a node as active that did not believe
  /// that it was its member.
  duration longest_lie() const {
    return longest_lie_;
  }

  /// Longest time that a node was active in two registries whose coordinators
  /// were connected.
  duration longest_double() const {
    return longest_double_;
  }

  const task_watch& tasks() const {
    return tasks_;
  }

  static constexpr duration period{250};

private:
  using moment = std::chrono::steady_clock::time_point;
  using place_key = std::pair<size_t, size_t>;

  void measure(std::map<place_key, moment>& since, const place_key& key,
               bool holds, duration& longest);

  site& place_;
  task_watch tasks_;
  std::map<place_key, moment> lies_;
  std::map<place_key, moment> doubles_;
  duration longest_lie_{0};
  duration longest_double_{0};
};

/// Prints the events that were told, and when.
void print_events(const site& place);

} // namespace roscell::test
