#pragma once

#include "messages/failure.hpp"

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// Somebody waits for a node to join.
struct awaited_arrival {
  std::chrono::steady_clock::time_point deadline;
  /// Called once: when it has joined, will not, or has not in time.
  completion_handler done;
};

/// Somebody waits until the sizes of all cells are known. Called once.
struct awaited_sizes {
  std::chrono::steady_clock::time_point deadline;
  std::function<void()> done;
};

/// The slots that this coordinator has granted in other cells, and who waits
/// for what about slots. A slot counts from the question whether a cell keeps
/// it until the node is seen there, so that nodes that come at the same moment
/// spread evenly. Pure: it is told the time.
class slot_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  // -- slots ------------------------------------------------------------------

  /// Counts at once. One that the node had elsewhere is dropped.
  void promise(const std::string& node, const std::string& coordinator,
               time_point now);

  /// The coordinator does not keep it, or the node has been seen somewhere.
  void forget(const std::string& node);
  void forget(const std::string& node, const std::string& coordinator);

  /// The coordinator that has a slot for the node; empty if none has.
  std::string find(const std::string& node, time_point now) const;

  /// How many slots there are in a cell, without the nodes that are counted
  /// there already.
  int64_t count_at(
      const std::string& coordinator,
      const std::function<bool(const std::string& node)>& is_counted) const;

  void drop_overdue_slots(time_point now);

  size_t size() const {
    return by_node_.size();
  }

  // -- arrivals ---------------------------------------------------------------

  /// False if too many wait; `done` is not kept then. Who takes it calls it.
  bool await_arrival(const std::string& node, completion_handler done,
                     time_point now);
  std::vector<awaited_arrival> take_arrivals(const std::string& node);
  std::vector<awaited_arrival> take_overdue_arrivals(time_point now);

  // -- sizes ------------------------------------------------------------------

  /// The same for the sizes.
  bool await_sizes(std::function<void()> done, time_point now);
  std::vector<awaited_sizes> take_all_who_await_sizes();
  std::vector<awaited_sizes> take_overdue_who_await_sizes(time_point now);

  /// When somebody waits no longer; max() if nobody waits.
  time_point next_deadline() const;

private:
  struct granted_slot {
    std::string coordinator; ///< UUID.
    time_point until;
  };

  std::map<std::string, granted_slot> by_node_; ///< UUIDs.
  std::multimap<std::string, awaited_arrival> arrivals_;
  std::deque<awaited_sizes> sizes_; ///< In the order of their deadlines.
};

} // namespace roscell
