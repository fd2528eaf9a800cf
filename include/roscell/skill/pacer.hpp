#pragma once

#include "roscell/skill/stop_event.hpp"

namespace roscell::engine {

/// Spreads frames in time. Does not catch up after a pause: the distance
/// between two frames is never shorter than the period. For one thread.
class pacer {
public:
  /// `rate_hz` is the most frames per second; 0 is no limit.
  explicit pacer(double rate_hz);

  /// Waits until the next frame is due. Returns false when `stop` was set.
  bool wait(const stop_event& stop);

  /// Takes the turn of the next frame if it is due, give or take a quarter of
  /// the period, or else returns false: for live inputs, which cannot wait but
  /// leave out what comes too early.
  bool take_turn();

private:
  stop_event::clock::duration period_{};
  stop_event::clock::time_point due_;
};

} // namespace roscell::engine
