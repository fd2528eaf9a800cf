#pragma once

#include <chrono>

namespace roscell::engine {

/// Tells everything that waits in a skill to come to its end. Once set it
/// stays set. All members may be called from any thread.
class stop_event {
public:
  using clock = std::chrono::steady_clock;

  /// Throws std::system_error when the process has no file descriptor left.
  stop_event();

  ~stop_event();

  stop_event(const stop_event&) = delete;
  stop_event& operator=(const stop_event&) = delete;

  void set() noexcept;

  bool is_set() const noexcept;

  /// Becomes readable when the event is set, and stays so; for use in poll().
  /// Nobody may read from it.
  int fd() const noexcept {
    return fd_;
  }

  /// Waits for the event.
  void wait() const;

  /// Waits for the event, but not past `deadline`. Returns whether it is set.
  bool wait_until(clock::time_point deadline) const;

  /// Waits until `other` is readable. Returns false when the event was set,
  /// also if both are true.
  bool wait_readable(int other) const;

private:
  const int fd_;
};

} // namespace roscell::engine
