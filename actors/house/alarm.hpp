#pragma once

#include <caf/atom.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace roscell {

/// The one timer of an actor. CAF's delayed messages cannot be taken back, so
/// each carries a number, and only the last one set may ring.
class alarm {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Makes `self` get a tick at `when`, or earlier when it is set already.
  /// Whoever gets one looks what is due and sets the alarm anew.
  template <class Self>
  void set(Self* self, time_point when) {
    if (set_ && due_ <= when)
      return;
    set_ = true;
    due_ = when;
    const auto now = self->clock().now();
    self->delayed_send(self, std::max(when - now, time_point::duration{0}),
                       caf::tick_atom_v, ++number_);
  }

  /// Whether tick `number` is the one that was set last.
  bool rings(uint64_t number) {
    if (!set_ || number != number_)
      return false;
    set_ = false;
    return true;
  }

private:
  uint64_t number_ = 0;
  bool set_ = false;
  time_point due_;
};

} // namespace roscell
