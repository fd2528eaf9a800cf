#pragma once

#include "test/site/site.hpp"

#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace roscell::test {

/// What is not as it shall be once things have calmed down, for people; empty
/// if all is well.
std::string complaint(const site& place);

/// Lets time pass until there is no complaint, and looks whether it stays so.
/// Gives what is left of it.
std::string calm_down(site& place);

/// Watches the invariants while there is trouble.
class site_watch {
public:
  using duration = std::chrono::milliseconds;

  explicit site_watch(site& place) : place_(place) {}

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

  static constexpr duration period{250};

private:
  using moment = std::chrono::steady_clock::time_point;
  using place_key = std::pair<size_t, size_t>;

  void measure(std::map<place_key, moment>& since, const place_key& key,
               bool holds, duration& longest);

  site& place_;
  std::map<place_key, moment> lies_;
  std::map<place_key, moment> doubles_;
  duration longest_lie_{0};
  duration longest_double_{0};
};

/// Prints the facts that were told, if ROSCELL_SEED asks for one run.
void print_facts(const site& place);

} // namespace roscell::test
