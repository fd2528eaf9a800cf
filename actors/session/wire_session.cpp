#include "actors/session/wire_session.hpp"

#include "actors/house/limits.hpp"
#include "actors/house/told_times.hpp"
#include "actors/house/watching.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

namespace roscell {

void session_wire::add_undone(std::function<void()> done) {
  std::lock_guard guard{mutex_};
  undone_.push_back(std::move(done));
}

std::function<void()> session_wire::take_undone() {
  std::lock_guard guard{mutex_};
  if (undone_.empty())
    return {};
  auto done = std::move(undone_.front());
  undone_.pop_front();
  return done;
}

namespace {

using session_self = session_actor::stateful_pointer<wire_session_state>;

void count_lost(session_self self, std::ptrdiff_t beats) {
  const auto& st = self->state;
  if (beats > 0)
    st.context.count(metric::beats_lost, {st.peer}, static_cast<double>(beats));
}

/// What is on its way when a session ends is not lost; what is older than the
/// pause before another question is.
void count_unanswered(session_self self) {
  const auto& st = self->state;
  const auto latest = st.context.boot_now_ms(self->system())
                      - limits::lease::probe_interval.count();
  count_lost(self,
             std::count_if(st.beats_sent.begin(), st.beats_sent.end(),
                           [&](const auto& x) { return x.second < latest; }));
}

void end_wire_session(session_self self, const std::string& reason) {
  auto& st = self->state;
  count_unanswered(self);
  if (st.owner)
    self->send(st.owner, session_closed{reason});
  st.wire->link->close(reason);
  self->quit();
}

/// Allows the connection to read one more frame.
void let_read_on(session_self self) {
  if (auto done = self->state.wire->take_undone())
    done();
}

void hand_over(session_self self, const frame_received& frame) {
  self->request(self->state.owner, limits::session::owner, frame)
      .then([self] { let_read_on(self); },
            [self](const caf::error&) {
              end_wire_session(self, "the receiving side is overloaded");
            });
}

void on_frame(session_self self, const frame_received& frame) {
  auto& st = self->state;
  ++st.frames_in;
  st.context.count(metric::session_received_bytes, {st.peer},
                   static_cast<double>(frame.text.size()));
  if (self->state.owner)
    hand_over(self, frame);
  else
    self->state.early_frames.push_back(frame);
}

void take_owner(session_self self, const own_session& wish) {
  auto& st = self->state;
  st.owner = wish.owner;
  watch_until_own_end(self, wish.owner);
  for (const auto& frame : std::exchange(st.early_frames, {}))
    hand_over(self, frame);
}

/// An ack has the number of the beat it answers, so that whoever sent that one
/// knows when it did. The time is taken before: it may count on that.
void send_out(session_self self, const send_beat& beat) {
  auto& st = self->state;
  const bool is_ack = beat.kind == beat_kind::ack && beat.answers != 0;
  const auto number = is_ack ? beat.answers : ++st.beat_sequence;
  if (beat.kind == beat_kind::beat) {
    st.context.count(metric::beats_sent, {st.peer});
    st.beats_sent.emplace_back(number, st.context.boot_now_ms(self->system()));
    if (st.beats_sent.size() > limits::session::remembered_beats) {
      st.beats_sent.pop_front();
      count_lost(self, 1);
    }
  }
  st.wire->beats->send(beat.kind, number);
  st.context.count(metric::session_sent_bytes, {st.peer}, beat_packet::size);
}

/// Finds the beat that an ack answers. Those before it are lost: what comes of
/// them later proves nothing that this one does not.
void settle_beats(session_self self, beat_received& ack) {
  auto& st = self->state;
  auto& sent = st.beats_sent;
  const auto found = std::find_if(sent.begin(), sent.end(), [&](const auto& x) {
    return x.first == ack.sequence;
  });
  if (found == sent.end())
    return;
  ack.sent_boot_ms = found->second;
  count_lost(self, found - sent.begin());
  sent.erase(sent.begin(), std::next(found));
}

void hand_over(session_self self, beat_received beat) {
  auto& st = self->state;
  st.context.count(metric::session_received_bytes, {st.peer},
                   beat_packet::size);
  if (beat.kind == beat_kind::ack)
    settle_beats(self, beat);
  if (st.owner)
    self->send(st.owner, beat);
}

void send_text(session_self self, const send_frame& frame) {
  auto& st = self->state;
  ++st.frames_out;
  st.context.count(metric::session_sent_bytes, {st.peer},
                   static_cast<double>(frame.text.size()));
  st.wire->link->send(frame.text);
}

} // namespace

session_actor::behavior_type
wire_session(session_self self, const house& context,
             const std::shared_ptr<session_wire>& wire,
             const std::string& peer) {
  self->state.context = context;
  self->state.wire = wire;
  self->state.peer = peer;
  self->set_down_handler([self](const caf::down_msg&) {
    end_wire_session(self, "the owner has ended");
  });
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"peer", st.peer},
                         {"frames_in", st.frames_in},
                         {"frames_out", st.frames_out},
                         {"queued_bytes", st.wire->link->queued_bytes()}});
      },
      [self](const own_session& wish) { take_owner(self, wish); },
      [self](const send_frame& frame) { send_text(self, frame); },
      [self](const send_beat& beat) { send_out(self, beat); },
      [self](const close_session& wish) {
        end_wire_session(self, wish.reason);
      },
      [self](const frame_received& frame) { on_frame(self, frame); },
      [self](const beat_received& beat) { hand_over(self, beat); },
      [self](const session_closed& fact) {
        end_wire_session(self, fact.reason);
      },
  };
}

namespace {

/// Words for why a connection ended.
std::string reason_of(const session_end& fact) {
  switch (fact.why) {
  case session_end::cause::closed_there:
    return "closed by the peer: " + fact.reason;
  case session_end::cause::lost:
    return "the connection was lost";
  default:
    return fact.reason;
  }
}

} // namespace

session_actor spawn_session(caf::actor_system& system, const house& context,
                            beat_socket& beats, established_session session,
                            uint16_t beat_port) {
  auto wire = std::make_shared<session_wire>();
  wire->link = session.link;
  auto self =
      spawn(system, context, wire_session, context, wire, session.peer.node);
  beat_registration place{session.agreement, "", 0, {}};
  if (beat_port != 0) {
    place.address = session.peer.address;
    place.port = beat_port;
  }
  place.on_beat = [self](beat_kind kind, uint32_t sequence) {
    caf::anon_send(self, beat_received{kind, sequence, 0});
  };
  wire->beats = beats.register_session(std::move(place));
  session_callbacks callbacks;
  callbacks.on_frame = [self, wire, ahead = session.ahead_ms](
                           std::string text, std::function<void()> done) {
    wire->add_undone(std::move(done));
    caf::anon_send(self, frame_received{with_times_shifted(std::move(text),
                                                           from_peer(ahead))});
  };
  callbacks.on_closed = [self](const session_end& fact) {
    caf::anon_send(self, session_closed{reason_of(fact)});
  };
  session.link->start(std::move(callbacks));
  return self;
}

} // namespace roscell
