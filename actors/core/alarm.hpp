#pragma once

#include <caf/atom.hpp>
#include <caf/send.hpp>

#include <chrono>
#include <cstdint>
#include <utility>

namespace roscell {

/// The type of the clock's timeouts that `actor_context.hpp` turns into ticks.
constexpr auto alarm_timeout = caf::atom("alarm");

/// The one timer of an actor that the spawn function has spawned. It is kept by
/// the clock as a timeout, of which an actor has one at a time, and which ends
/// with it: a delayed message cannot be taken back, and keeps the whole actor
/// until it is due. A tick may be under way when the alarm is set anew, so each
/// carries a number, and only the last one set may ring.
class alarm {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Makes `self` get a tick at `when`, or earlier when it is set already.
  /// Whoever gets one looks what is due and sets the alarm anew.
  template <class Self>
  void set(Self* self, time_point when) {
    if (!set_ || when < due_)
      set_anew(self, when);
  }

  /// Makes `self` get a tick at `when`, and not before.
  template <class Self>
  void set_anew(Self* self, time_point when) {
    set_ = true;
    due_ = when;
    self->clock().set_ordinary_timeout(when, self, alarm_timeout, ++number_);
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

/// `whom`, which lives as long as its node, gets `what` after `delay`. The
/// clock keeps both until then, and nobody can take it back: an actor that may
/// end earlier has an `alarm`.
template <class Handle, class Delay, class What>
void send_lasting_actor_later(const Handle& whom, Delay delay, What what) {
  caf::delayed_anon_send(whom, delay, std::move(what));
}

} // namespace roscell
