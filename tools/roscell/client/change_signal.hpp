#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

namespace roscell::cli {

/// Collects events, so that many of them that arrive while somebody is at work
/// are answered by one more look.
class change_signal {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// @param node has to outlive it.
  explicit change_signal(const node_client& node);

  /// Waits for an event since the last call. Throws what ended the events.
  void wait() {
    wait_until(time_point::max());
  }

  /// The same until then. False if there was none.
  bool wait_until(time_point limit);

private:
  void note(const std::exception_ptr& end = nullptr);

  std::mutex mutex_;
  std::condition_variable news_;
  bool changed_ = false;
  std::exception_ptr ended_;
  event_follower events_; // Last: it uses all the others.
};

} // namespace roscell::cli
