#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// The one place of a node where room is held for an instance that is not there
/// yet: from its reservation until the supervisor knows it, it is given up, or
/// its time is over. Told the time; bounded.
class reservation_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Keeps room for an instance, in place of what was kept for it before. Says
  /// why not.
  std::optional<std::string> keep(const instance_spec& spec, time_point now);

  /// Gives up what is kept for an instance of a task, or for all of them if
  /// `instance` is empty.
  void give_up(const std::string& task, const std::string& instance);

  /// The instances that room is kept for, without those of `known`: they count
  /// for themselves. What is over is forgotten.
  std::vector<instance_spec> open(time_point now,
                                  const std::set<std::string>& known);

  size_t size() const {
    return reservations_.size();
  }

private:
  struct held_spec {
    instance_spec spec;
    time_point until;
  };

  void forget_outdated(time_point now);

  std::map<std::string, held_spec> reservations_; ///< By instance.
};

} // namespace roscell
