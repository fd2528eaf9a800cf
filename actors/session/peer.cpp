#include "actors/session/peer.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/limits.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"

#include <utility>

namespace roscell {

namespace {

using peer_self = peer_actor::stateful_pointer<peer_state>;

void set_timer(peer_self self) {
  auto& st = self->state;
  if (!st.ended)
    st.timer.set(self, st.next());
}

/// Closes the session and ends the actor.
void end_peer(peer_self self, const std::string& reason) {
  auto& st = self->state;
  if (std::exchange(st.ended, true))
    return;
  st.frames.calls().fail_all("the coordinator of cell '" + st.cell
                             + "' is out of reach: " + reason);
  self->send(st.setup.coordinator,
             peer_lost{peer_actor{self}, st.setup.uuid, reason});
  self->send(st.session, close_session{reason});
  self->quit();
}

// -- what the other coordinator asks ------------------------------------------

template <class Reply, class Request>
void pass_on(peer_self self, const session_inquiry& x,
             std::chrono::milliseconds timeout) {
  auto what = decode<Request>(x.body);
  if (auto* why = std::get_if<failure>(&what))
    return self->state.frames.answer(*x.id, error_reply(*why));
  auto answer = [self, id = *x.id](const json& body) {
    if (!self->state.ended)
      self->state.frames.answer(id, body);
  };
  self->request(self->state.setup.coordinator, timeout,
                std::get<Request>(std::move(what)))
      .then([answer](const Reply& reply) { answer(message_json(reply)); },
            [answer](const caf::error& why) {
              answer(error_reply(to_failure(why)));
            });
}

void on_question(peer_self self, const session_inquiry& x) {
  const auto type = x.type();
  if (type == place_request::type)
    pass_on<place_granted, place_request>(self, x, limits::membership::place);
  else if (type == place_reservation::type)
    pass_on<place_reserved, place_reservation>(self, x,
                                               limits::session::peer_answer);
  else if (type == member_surrender::type)
    pass_on<members_surrendered, member_surrender>(self, x,
                                                   limits::transfer::forwarded);
  else if (type == node_transfer::type)
    pass_on<node_transferred, node_transfer>(self, x,
                                             limits::transfer::forwarded);
  else if (type == node_release::type)
    pass_on<node_released, node_release>(self, x, limits::transfer::forwarded);
  else
    self->state.frames.answer(
        *x.id, error_reply({error_code::unknown_type,
                            "a coordinator may not ask for this", "/type"}));
}

void on_notice(peer_self self, const json& body) {
  auto& st = self->state;
  const auto type = body.value("type", "");
  if (type == cell_standing::type) {
    auto reported = decode<cell_standing>(body);
    auto* status = std::get_if<cell_standing>(&reported);
    if (!status || status->uuid != st.setup.uuid)
      return end_peer(self, "it says that it is another one than it proved");
    st.cell = status->place.cell;
    self->send(st.setup.coordinator,
               peer_status_reported{peer_actor{self}, std::move(*status)});
  } else if (type == cell_changed::type) {
    auto reported = decode<cell_changed>(body);
    if (auto* change = std::get_if<cell_changed>(&reported))
      self->send(st.setup.coordinator,
                 peer_changed{peer_actor{self}, std::move(*change)});
  }
}

// -- what the session brings --------------------------------------------------

void on_frame(peer_self self, const frame_received& frame) {
  auto& st = self->state;
  if (st.ended || !is_from_session(self))
    return;
  if (auto x = hear_frame(self, frame)) {
    if (x->id)
      on_question(self, *x);
    else
      on_notice(self, x->body);
  }
  if (st.frames.hopeless())
    end_peer(self, "it sent frames that make no sense");
  set_timer(self);
}

void on_heartbeat(peer_self self, const heartbeat_received& heartbeat) {
  if (!self->state.ended && is_from_session(self))
    hear_heartbeat(self, heartbeat);
}

void on_tick(peer_self self, uint64_t number) {
  auto& st = self->state;
  if (st.ended || !st.timer.rings(number))
    return;
  st.frames.calls().expire(self->clock().now());
  if (!keep_lease(self))
    return end_peer(self, missed_heartbeats_text());
  set_timer(self);
}

// -- what the own coordinator asks
// ---------------------------------------------

template <class Reply, class Request>
caf::result<Reply> ask(peer_self self, const Request& what,
                       std::chrono::milliseconds timeout) {
  auto reply = ask_other_side<Reply>(self, what, timeout);
  set_timer(self);
  return reply;
}

/// A node's name, its UUID and the words around them.
constexpr size_t most_claim_bytes = 512;

static_assert(2 * limits::cell::rows * most_claim_bytes
                  < limits::session::frame_bytes,
              "a whole cell can be told of, and be gone, in one frame");

/// Who is not told something has a wrong picture of this cell for good.
template <class Event>
void notify_peer(peer_self self, const Event& event) {
  if (!self->state.ended && !self->state.frames.notify(message_json(event)))
    end_peer(self, "what it is to be told does not fit into a frame");
}

actor_state describe(peer_self self) {
  const auto& st = self->state;
  return state_of({{"cell", st.cell},
                   {"uuid", st.setup.uuid},
                   {"opened_here", st.setup.opened_here},
                   {"pending_calls", st.frames.calls().pending()}});
}

void take_over(peer_self self, const peer_setup& setup) {
  auto& st = self->state;
  st.setup = setup;
  hold_session(self, setup.session,
               setup.opened_here ? lease_side::member
                                 : lease_side::coordinator);
  watch_until_own_end(self, setup.coordinator);
  self->set_down_handler([self](const caf::down_msg& down) {
    end_peer(self, down.source == self->state.session
                       ? "its session has failed"
                       : "the coordinator has stopped");
  });
  self->send(setup.coordinator,
             peer_opened{peer_actor{self}, setup.uuid, setup.opened_here});
  set_timer(self);
}

} // namespace

peer_actor::behavior_type peer(peer_self self, const peer_setup& setup) {
  take_over(self, setup);
  return {
      [self](const state_query&) { return describe(self); },
      [self](const place_request& x) {
        return ask<place_granted>(
            self, x, limits::membership::place - limits::session::margin);
      },
      [self](const place_reservation& x) {
        return ask<place_reserved>(self, x, limits::session::peer_answer);
      },
      [self](const member_surrender& x) {
        return ask<members_surrendered>(self, x, limits::transfer::forwarded);
      },
      [self](const node_transfer& x) {
        return ask<node_transferred>(self, x, limits::transfer::forwarded);
      },
      [self](const node_release& x) {
        return ask<node_released>(self, x, limits::transfer::forwarded);
      },
      [self](const cell_standing& x) { notify_peer(self, x); },
      [self](const cell_changed& x) { notify_peer(self, x); },
      [self](const frame_received& frame) { on_frame(self, frame); },
      [self](const heartbeat_received& heartbeat) {
        on_heartbeat(self, heartbeat);
      },
      [self](const session_closed& event) {
        if (is_from_session(self))
          end_peer(self, event.reason);
      },
      [self](const close_session& request) { end_peer(self, request.reason); },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
