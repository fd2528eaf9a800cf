#pragma once

#include "test/fixture.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// The seam at which tests lose, delay, repeat and cut: two session actors that
/// are the two ends of one wire. Everything random comes from one seed.
namespace roscell::test {

/// What a wire does to what passes. Probabilities are per frame or heartbeat.
struct wire_faults {
  double drop_heartbeat = 0;
  double repeat_heartbeat = 0;
  double drop_frame = 0; ///< TCP never does; whoever survives it is robust.
  double repeat_frame = 0;
  double cut = 0;       ///< The frame is lost and the connection with it.
  bool reorder = false; ///< Frames may overtake each other.
  std::chrono::milliseconds shortest_delay{0};
  std::chrono::milliseconds longest_delay{0}; ///< Not below `shortest_delay`.
  double hold_frame = 0; ///< It is late, and so is what follows it.
  std::chrono::milliseconds late_by{3000}; ///< So late is a frame then.
};

/// What a test decides about one frame.
enum class frame_fate { passed, lost, repeated, late };

/// One connection, shared by its two ends and the test.
struct wire {
  std::mt19937& random;
  const wire_faults& faults;
  std::array<session_actor, 2> ends;
  std::array<caf::actor_addr, 2> owners; ///< Invalid until there is one.
  /// Decides about a frame that this end sends; may be empty.
  std::function<frame_fate(size_t)> judge;
  std::array<std::chrono::steady_clock::time_point, 2> last_arrival;
  /// Nothing passes and nobody is told: a cable pulled out.
  bool silent = false;
  std::array<bool, 2> mute{}; ///< The same for what this end sends.
  bool open = true;
  bool lossy = false; ///< A frame has been lost or overtaken.
  /// Frames that wait for the end of the silence, with their receivers.
  std::vector<std::pair<size_t, std::string>> held;
  size_t frames = 0;
  size_t heartbeats = 0;

  wire(std::mt19937& randomness, const wire_faults& what)
      : random(randomness), faults(what) {}

  /// Whether what this end sends is held back.
  bool holds(size_t end) const {
    return silent || mute[end];
  }

  bool happens(double probability) {
    return probability > 0
           && std::uniform_real_distribution<double>{}(random) < probability;
  }

  std::chrono::milliseconds delay() {
    const auto spread = (faults.longest_delay - faults.shortest_delay).count();
    return faults.shortest_delay
           + std::chrono::milliseconds{
               spread <= 0 ? 0 : static_cast<int64_t>(random() % (spread + 1))};
  }
};

using wire_ptr = std::shared_ptr<wire>;

/// One end of a wire.
struct wire_end_state {
  static constexpr const char* name = "wire-end";

  wire_ptr link;
  size_t index = 0;
  session_owner_actor owner;
  std::vector<std::string> kept;    ///< Frames from before there was an owner.
  std::string end_reason;           ///< Set when it ended before it had one.
  uint32_t number = 0;              ///< Of the last heartbeat.
  std::map<uint32_t, int64_t> sent; ///< When heartbeats were sent.
};

namespace wire_steps {

using self_pointer = session_actor::stateful_pointer<wire_end_state>;

/// Ends this end; its owner is told.
inline void end(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  if (!st.owner) {
    st.end_reason = reason;
    return;
  }
  self->send(st.owner, session_closed{reason});
  self->quit();
}

/// Ends the other end, after what is on its way to it.
inline void end_other(self_pointer self, const std::string& reason) {
  auto& link = *self->state.link;
  if (!std::exchange(link.open, false) || link.holds(self->state.index))
    return;
  const auto other = 1 - self->state.index;
  const auto now = self->clock().now();
  const auto when = std::max(now, link.last_arrival[other]) - now;
  self->delayed_send(link.ends[other], when, session_closed{reason});
}

/// Lets one frame arrive at the other end.
inline void pass(self_pointer self, const std::string& text,
                 std::chrono::milliseconds extra = {}) {
  auto& link = *self->state.link;
  const auto other = 1 - self->state.index;
  const auto now = self->clock().now();
  auto when = now + link.delay() + extra;
  if (link.faults.reorder)
    link.lossy |= when < link.last_arrival[other];
  else
    when = std::max(when, link.last_arrival[other]);
  link.last_arrival[other] = std::max(when, link.last_arrival[other]);
  self->delayed_send(link.ends[other], when - now, frame_received{text});
}

inline void send_out(self_pointer self, const std::string& text) {
  auto& link = *self->state.link;
  ++link.frames;
  if (!link.open)
    return;
  if (link.holds(self->state.index)) {
    link.held.emplace_back(1 - self->state.index, text);
    return;
  }
  if (link.happens(link.faults.cut)) {
    end_other(self, "the connection broke");
    end(self, "the connection broke");
    return;
  }
  const auto fate =
      link.judge ? link.judge(self->state.index) : frame_fate::passed;
  if (fate == frame_fate::lost || link.happens(link.faults.drop_frame)) {
    link.lossy = true;
    return;
  }
  const bool late =
      fate == frame_fate::late || link.happens(link.faults.hold_frame);
  pass(self, text, late ? link.faults.late_by : std::chrono::milliseconds{0});
  if (fate == frame_fate::repeated || link.happens(link.faults.repeat_frame))
    pass(self, text);
}

inline void send_out(self_pointer self, const send_heartbeat& heartbeat) {
  auto& link = *self->state.link;
  auto& sent = self->state.sent;
  const auto number =
      heartbeat.answers != 0 ? heartbeat.answers : ++self->state.number;
  if (heartbeat.kind == heartbeat_kind::heartbeat)
    sent[number] = virtual_time::boot_now_ms(self->system());
  ++link.heartbeats;
  if (!link.open || link.holds(self->state.index)
      || link.happens(link.faults.drop_heartbeat))
    return;
  const auto times = link.happens(link.faults.repeat_heartbeat) ? 2 : 1;
  for (auto i = 0; i < times; ++i)
    self->delayed_send(link.ends[1 - self->state.index], link.delay(),
                       heartbeat_received{heartbeat.kind, number, 0});
}

inline void take_owner(self_pointer self, const session_owner_actor& owner) {
  auto& st = self->state;
  st.owner = owner;
  st.link->owners[st.index] = owner.address();
  self->monitor(owner);
  // What a kernel does for a program that was killed.
  self->set_down_handler([self](const caf::down_msg&) {
    end_other(self, "the peer has ended");
    self->quit();
  });
  for (auto& text : std::exchange(st.kept, {}))
    self->send(owner, frame_received{std::move(text)});
  if (!st.end_reason.empty())
    end(self, st.end_reason);
}

inline void come_in(self_pointer self, const frame_received& frame) {
  auto& st = self->state;
  if (st.owner)
    self->send(st.owner, frame);
  else
    st.kept.push_back(frame.text);
}

} // namespace wire_steps

inline session_actor::behavior_type wire_end(wire_steps::self_pointer self,
                                             wire_ptr link, size_t index) {
  using namespace wire_steps;
  self->state.link = std::move(link);
  self->state.index = index;
  return {
      [self](const state_query&) {
        return state_of({{"end", "wire"}});
      },
      [self](const own_session& x) { take_owner(self, x.owner); },
      [self](const send_frame& x) { send_out(self, x.text); },
      [self](const send_heartbeat& x) { send_out(self, x); },
      [self](const close_session& x) {
        end_other(self, x.reason);
        self->quit();
      },
      [self](const frame_received& x) { come_in(self, x); },
      [self](heartbeat_received x) {
        const auto& sent = self->state.sent;
        const auto i = sent.find(x.sequence);
        if (x.kind == heartbeat_kind::ack && i != sent.end())
          x.sent_boot_ms = i->second;
        if (self->state.owner)
          self->send(self->state.owner, x);
      },
      [self](const session_closed& x) { end(self, x.reason); },
  };
}

/// Makes a wire and its two ends.
inline wire_ptr make_wire(caf::actor_system& system,
                          const actor_context& context, std::mt19937& random,
                          const wire_faults& faults) {
  auto result = std::make_shared<wire>(random, faults);
  for (size_t i = 0; i < 2; ++i)
    result->ends[i] = roscell::spawn(system, context, wire_end, result, i);
  return result;
}

/// Breaks the connection; both ends are told at once.
inline void cut(wire& x) {
  x.open = false;
  for (auto& end : x.ends)
    caf::anon_send(end, session_closed{"the connection broke"});
}

/// Lets a frame arrive that was held back, not before what was sent earlier.
inline void pass_on(wire& x, size_t receiver, std::string text) {
  const auto now = x.ends[receiver].home_system().clock().now();
  caf::delayed_anon_send(x.ends[receiver],
                         std::max(now, x.last_arrival[receiver]) - now,
                         frame_received{std::move(text)});
}

/// Lets arrive what was held back of what these ends have sent, and the news
/// that the other end has gone.
inline void release(wire& x, const std::array<bool, 2>& senders) {
  decltype(x.held) still;
  for (auto& [receiver, text] : std::exchange(x.held, {})) {
    if (senders[1 - receiver])
      pass_on(x, receiver, std::move(text));
    else
      still.emplace_back(receiver, std::move(text));
  }
  x.held = std::move(still);
  if (!x.open)
    cut(x);
}

/// Lets only these ends be heard no more; whoever was mute before is heard.
inline void mute(wire& x, const std::array<bool, 2>& ends) {
  const auto before = std::exchange(x.mute, ends);
  if (!x.silent && (before[0] || before[1]))
    release(x, {before[0] && !ends[0], before[1] && !ends[1]});
}

/// Ends a silence.
inline void heal(wire& x) {
  const auto muted = std::exchange(x.mute, {});
  if (std::exchange(x.silent, false) || muted[0] || muted[1])
    release(x, {true, true});
}

} // namespace roscell::test
