#pragma once

#include <atomic>
#include <mutex>
#include <set>
#include <string>

namespace roscell {

/// Ends a search whose nodes do not stay. The scheduler hears no message while
/// it searches, so the coordinator tells it through this; safe for threads.
class search_guard {
public:
  /// A search on these nodes begins.
  void begin(std::set<std::string> nodes);

  /// A node can be used no more.
  void node_left(const std::string& node);

  /// Whether a node of the search has left.
  bool must_stop() const {
    return stopped_;
  }

  /// The search is over. Returns the first of its nodes that left, or nothing.
  std::string end();

private:
  std::mutex mutex_;
  std::set<std::string> nodes_;
  std::string gone_;
  std::atomic<bool> stopped_{false};
};

} // namespace roscell
