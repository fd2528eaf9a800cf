#include "actors/session/wire_session.hpp"

#include "actors/core/shifted_times.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"

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

void count_lost(session_self self, std::ptrdiff_t heartbeats) {
  const auto& st = self->state;
  if (heartbeats > 0)
    st.context.count(metric::heartbeats_lost, {st.peer},
                     static_cast<double>(heartbeats));
}

/// What is on its way when a session ends is not lost; what is older than the
/// pause before another question is.
void count_unanswered(session_self self) {
  const auto& st = self->state;
  const auto latest = st.context.boot_now_ms(self->system())
                      - limits::lease::probe_interval.count();
  count_lost(self,
             std::count_if(st.heartbeats_sent.begin(), st.heartbeats_sent.end(),
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

void take_owner(session_self self, const own_session& request) {
  auto& st = self->state;
  st.owner = request.owner;
  watch_until_own_end(self, request.owner);
  for (const auto& frame : std::exchange(st.early_frames, {}))
    hand_over(self, frame);
}

/// An ack has the number of the heartbeat it answers, so that whoever sent that
/// one knows when it did. The time is taken before: it may count on that.
void send_out(session_self self, const send_heartbeat& heartbeat) {
  auto& st = self->state;
  const bool is_ack =
      heartbeat.kind == heartbeat_kind::ack && heartbeat.answers != 0;
  const auto number = is_ack ? heartbeat.answers : ++st.heartbeat_sequence;
  if (heartbeat.kind == heartbeat_kind::heartbeat) {
    st.context.count(metric::heartbeats_sent, {st.peer});
    st.heartbeats_sent.emplace_back(number,
                                    st.context.boot_now_ms(self->system()));
    if (st.heartbeats_sent.size() > limits::session::remembered_heartbeats) {
      st.heartbeats_sent.pop_front();
      count_lost(self, 1);
    }
  }
  st.wire->heartbeats->send(heartbeat.kind, number);
  st.context.count(metric::session_sent_bytes, {st.peer},
                   heartbeat_packet::size);
}

/// Finds the heartbeat that an ack answers. Those before it are lost: what
/// comes of them later proves nothing that this one does not.
void settle_heartbeats(session_self self, heartbeat_received& ack) {
  auto& st = self->state;
  auto& sent = st.heartbeats_sent;
  const auto found = std::find_if(sent.begin(), sent.end(), [&](const auto& x) {
    return x.first == ack.sequence;
  });
  if (found == sent.end())
    return;
  ack.sent_boot_ms = found->second;
  count_lost(self, found - sent.begin());
  sent.erase(sent.begin(), std::next(found));
}

void hand_over(session_self self, heartbeat_received heartbeat) {
  auto& st = self->state;
  st.context.count(metric::session_received_bytes, {st.peer},
                   heartbeat_packet::size);
  if (heartbeat.kind == heartbeat_kind::ack)
    settle_heartbeats(self, heartbeat);
  if (st.owner)
    self->send(st.owner, heartbeat);
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
wire_session(session_self self, const actor_context& context,
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
      [self](const own_session& request) { take_owner(self, request); },
      [self](const send_frame& frame) { send_text(self, frame); },
      [self](const send_heartbeat& heartbeat) { send_out(self, heartbeat); },
      [self](const close_session& request) {
        end_wire_session(self, request.reason);
      },
      [self](const frame_received& frame) { on_frame(self, frame); },
      [self](const heartbeat_received& heartbeat) {
        hand_over(self, heartbeat);
      },
      [self](const session_closed& event) {
        end_wire_session(self, event.reason);
      },
  };
}

namespace {

/// Words for why a connection ended.
std::string reason_of(const session_end& event) {
  switch (event.why) {
  case session_end::cause::closed_there:
    return "closed by the peer: " + event.reason;
  case session_end::cause::lost:
    return "the connection was lost";
  default:
    return event.reason;
  }
}

} // namespace

session_actor spawn_session(caf::actor_system& system,
                            const actor_context& context,
                            heartbeat_socket& heartbeats,
                            established_session session,
                            uint16_t heartbeat_port) {
  auto wire = std::make_shared<session_wire>();
  wire->link = session.link;
  auto self =
      spawn(system, context, wire_session, context, wire, session.peer.node);
  heartbeat_registration place{session.agreement, "", 0, {}};
  if (heartbeat_port != 0) {
    place.address = session.peer.address;
    place.port = heartbeat_port;
  }
  place.on_heartbeat = [self](heartbeat_kind kind, uint32_t sequence) {
    caf::anon_send(self, heartbeat_received{kind, sequence, 0});
  };
  wire->heartbeats = heartbeats.register_session(std::move(place));
  session_callbacks callbacks;
  callbacks.on_frame = [self, wire, ahead = session.ahead_ms](
                           std::string text, std::function<void()> done) {
    wire->add_undone(std::move(done));
    caf::anon_send(self, frame_received{with_times_shifted(std::move(text),
                                                           from_peer(ahead))});
  };
  callbacks.on_closed = [self](const session_end& event) {
    caf::anon_send(self, session_closed{reason_of(event)});
  };
  session.link->start(std::move(callbacks));
  return self;
}

} // namespace roscell
