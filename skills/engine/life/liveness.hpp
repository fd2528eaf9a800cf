#pragma once

#include <chrono>
#include <mutex>
#include <optional>

namespace roscell::engine {

/// Decides whether a skill may still say that it is alive. It may while the
/// executor waits for a frame or began the current one less than half a
/// watchdog period ago. With heartbeats at every half period this means: work
/// that takes less than one period never looks hung, work that takes more than
/// one and a half always does. All members may be called from any thread.
class liveness {
public:
  using clock = std::chrono::steady_clock;

  /// `period` is the time after which the node takes a silent skill for hung.
  explicit liveness(clock::duration period) : period_(period) {
    // nop
  }

  void work_begins(clock::time_point now);

  /// Returns true when a heartbeat was withheld during this work; it is to be
  /// sent at once, because the next regular one may come too late.
  bool work_ends();

  /// Whether the heartbeat that is due `now` may be sent.
  bool allows_heartbeat(clock::time_point now);

  clock::duration period() const noexcept {
    return period_;
  }

private:
  const clock::duration period_;
  std::mutex mutex_;
  std::optional<clock::time_point> busy_since_;
  bool withheld_ = false;
};

} // namespace roscell::engine
