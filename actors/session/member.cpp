#include "actors/session/member.hpp"

#include "actors/house/limits.hpp"
#include "actors/house/relayed_requests.hpp"
#include "actors/house/wall_clock.hpp"
#include "actors/session/forwarded_requests.hpp"
#include "actors/session/long_starts.hpp"
#include "actors/session/session_envelope.hpp"
#include "schemas/document.hpp"

#include <caf/typed_response_promise.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using member_self = member_actor::stateful_pointer<member_state>;

using phase = member_phase;

auto now(member_self self) {
  return self->clock().now();
}

void set_timer(member_self self) {
  auto& st = self->state;
  if (st.ended)
    return;
  auto when = std::min(st.life.next(), st.frames.calls().next_deadline());
  if (st.phase == phase::awaiting)
    when = std::min(when, st.registration_deadline);
  st.timer.set(self, when);
}

/// Closes the session and ends the actor.
/// Since the node's last word.
std::chrono::milliseconds silence_of(member_self self) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      self->clock().now() - self->state.life.last_heard());
}

void end_member(member_self self, const std::string& reason) {
  auto& st = self->state;
  if (std::exchange(st.ended, true))
    return;
  st.frames.calls().fail_all("node '" + st.peer.name
                             + "' is out of reach: " + reason);
  if (st.announced && st.phase != phase::departed)
    self->send(st.coordinator,
               member_lost{st.peer.uuid, caf::actor_cast<member_actor>(self),
                           reason, silence_of(self).count()});
  self->send(st.session, close_session{reason});
  self->quit();
}

void refuse_call(member_self self, uint64_t id, const failure& why) {
  self->state.frames.answer(id, error_reply(why));
}

// -- what the node asks ------------------------------------------------------

/// What a node says of itself is believed, except who it is.
void set_name(node_registration& x, const std::string& name) {
  x.identity.name = name;
  x.resources.name = name;
  for (auto& row : x.instances)
    row.node = name;
}

bool is_proven(const node_identity& claimed, const node_identity& proven) {
  return claimed.name == proven.name && claimed.uuid == proven.uuid
         && claimed.epoch == proven.epoch;
}

void on_row_refused(member_self self, uint64_t id, const caf::error& why) {
  const auto reason = to_failure(why);
  refuse_call(self, id, reason);
  end_member(self, reason.message);
}

/// The node does not have to hear of an instance twice if the session ends: it
/// registers anew then.
void on_late_start_failed(member_self self, const instance_spec& spec,
                          const caf::error& error) {
  const auto why = to_failure(error);
  if (why.code == error_code::unreachable)
    return;
  instance_changed fact;
  fact.instance.spec = spec;
  fact.instance.node = self->state.peer.name;
  fact.instance.state = instance_state::failed;
  fact.instance.since_unix_ms = unix_now_ms();
  fact.instance.reason = why.message;
  self->send(self->state.coordinator, std::move(fact));
}

void start_late(member_self self, const instance_spec& spec) {
  self->state.frames.call(message_json(instance_deployment{spec}),
                          now(self) + limits::task::deployment,
                          [self, spec](const caf::expected<json>& reply) {
                            if (!reply)
                              on_late_start_failed(self, spec, reply.error());
                          });
  set_timer(self);
}

void on_row(member_self self, uint64_t id, node_registered reply) {
  auto& st = self->state;
  st.phase = phase::active;
  const auto late = take_long_starts(reply);
  st.frames.answer(id, message_json(reply));
  for (const auto& spec : late)
    start_late(self, spec);
}

void ask_for_row(member_self self, uint64_t id, node_registration wish) {
  auto& st = self->state;
  st.phase = phase::registering;
  st.announced = true;
  set_name(wish, st.peer.name);
  self->request(
          st.coordinator, limits::membership::row,
          register_node{std::move(wish), caf::actor_cast<member_actor>(self)})
      .then(
          [self, id](node_registered& reply) {
            on_row(self, id, std::move(reply));
          },
          [self, id](const caf::error& why) { on_row_refused(self, id, why); });
}

void on_registration(member_self self, uint64_t id, const json& body) {
  auto& st = self->state;
  auto wish = decode<node_registration>(body);
  if (auto* why = std::get_if<failure>(&wish))
    return refuse_call(self, id, *why);
  if (st.phase != phase::awaiting)
    return refuse_call(
        self, id, {error_code::conflict, "this session is registered already"});
  auto& registration = std::get<node_registration>(wish);
  if (is_proven(registration.identity, st.peer))
    return ask_for_row(self, id, std::move(registration));
  refuse_call(self, id,
              {error_code::unauthorized,
               "the registration is not of the node that opened the session",
               "/identity"});
  end_member(self, "it registered with another identity than it proved");
}

void on_departure(member_self self, uint64_t id, const json& body) {
  auto& st = self->state;
  const auto reason = body.value("reason", "");
  st.phase = phase::departing;
  self->request(st.coordinator, limits::membership::departure,
                depart_node{st.peer.uuid, caf::actor_cast<member_actor>(self),
                            reason})
      .then(
          [self, id](const node_departed& reply) {
            self->state.phase = phase::departed;
            self->state.frames.answer(id, message_json(reply));
          },
          [self, id](const caf::error& why) { on_row_refused(self, id, why); });
}

/// A node that is in no cell wants a place. It ends the session when it has
/// been told.
void on_place_request(member_self self, uint64_t id, const json& body) {
  auto& st = self->state;
  auto wish = decode<place_request>(body);
  if (auto* why = std::get_if<failure>(&wish))
    return refuse_call(self, id, *why);
  auto& x = std::get<place_request>(wish);
  x.name = st.peer.name;
  x.uuid = st.peer.uuid;
  self->request(st.coordinator, limits::membership::place, x)
      .then(
          [self, id](const place_granted& reply) {
            self->state.frames.answer(id, message_json(reply));
          },
          [self, id](const caf::error& why) {
            refuse_call(self, id, to_failure(why));
          });
}

/// The node's user asks what only a coordinator can answer. It is answered
/// here, so it goes no further.
void on_forwarded(member_self self, uint64_t id, const json& body,
                  std::chrono::milliseconds limit) {
  self->request(self->state.coordinator, limit, route_request{body.dump(), ""})
      .then(
          [self, id](const request_routed& reply) {
            self->state.frames.answer(id, body_of(reply));
          },
          [self, id](const caf::error& why) {
            refuse_call(self, id, to_failure(why));
          });
}

void on_request(member_self self, uint64_t id, const session_inquiry& x) {
  const auto type = x.type();
  if (type == place_request::type && self->state.phase == phase::awaiting)
    return on_place_request(self, id, x.body);
  if (type == node_registration::type)
    return on_registration(self, id, x.body);
  if (self->state.phase != phase::active) {
    refuse_call(self, id,
                {error_code::conflict, "this session has no registered node"});
    if (self->state.phase == phase::awaiting)
      end_member(self, "its first request was no registration");
    return;
  }
  if (type == node_departure::type)
    return on_departure(self, id, x.body);
  if (const auto waits = forwarding_of(type))
    return on_forwarded(self, id, x.body, waits->coordinator);
  refuse_call(
      self, id,
      {error_code::unknown_type, "a member may not ask for this", "/type"});
}

void on_notice(member_self self, const json& body) {
  auto& st = self->state;
  if (body.value("type", "") != instance_changed::type
      || st.phase != phase::active)
    return;
  auto fact = decode<instance_changed>(body);
  if (auto* x = std::get_if<instance_changed>(&fact)) {
    x->instance.node = st.peer.name;
    self->send(st.coordinator, *x);
  }
}

// -- what the session brings -------------------------------------------------

bool is_from_session(member_self self) {
  const auto& sender = self->current_sender();
  return sender && sender->id() == self->state.session.id();
}

void on_frame(member_self self, const frame_received& frame) {
  auto& st = self->state;
  if (st.ended || !is_from_session(self))
    return;
  st.life.heard(now(self));
  if (auto x = st.frames.receive(frame.text)) {
    if (x->id)
      on_request(self, *x->id, *x);
    else
      on_notice(self, x->body);
  }
  if (st.frames.hopeless())
    end_member(self, "it sent frames that make no sense");
  set_timer(self);
}

void on_beat(member_self self, const beat_received& beat) {
  auto& st = self->state;
  if (st.ended || !is_from_session(self))
    return;
  if (auto answer = st.life.heard_beat(beat.kind, now(self)))
    self->send(st.session, send_beat{*answer, beat.sequence});
}

void on_tick(member_self self, uint64_t number) {
  auto& st = self->state;
  if (st.ended || !st.timer.rings(number))
    return;
  const auto time = now(self);
  if (st.phase == phase::awaiting && time >= st.registration_deadline)
    return end_member(self, "it did not register in time");
  st.frames.calls().expire(time);
  if (time >= st.life.next()) {
    const auto next = st.life.due(time);
    if (next.over)
      return end_member(self, silence_of_a_lease());
    if (next.send)
      self->send(st.session, send_beat{*next.send, 0});
  }
  set_timer(self);
}

// -- what the coordinator asks -----------------------------------------------

/// A check of what the node answered, or a correction of it.
template <class Reply>
using review = std::function<void(Reply&)>;

template <class Reply, class Request>
caf::result<Reply> ask_node(member_self self, const Request& what,
                            std::chrono::milliseconds timeout,
                            const review<Reply>& look = nullptr) {
  auto& st = self->state;
  if (st.phase != phase::active)
    return fail(error_code::unreachable,
                "node '" + st.peer.name + "' is not a member now");
  auto promise = self->make_response_promise<Reply>();
  auto on_result = [promise, look](caf::expected<json> body) mutable {
    auto reply = body ? reply_as<Reply>(*body) : body.error();
    if (reply && look)
      look(*reply);
    if (reply)
      promise.deliver(std::move(*reply));
    else
      promise.deliver(std::move(reply.error()));
  };
  st.frames.call(message_json(what), now(self) + timeout, std::move(on_result));
  set_timer(self);
  return promise;
}

/// Another node's user asks what only this node can answer.
caf::result<request_routed> relay(member_self self,
                                  const route_request& request) {
  auto& st = self->state;
  auto parsed = parse_document(request.text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return to_error(*why);
  const auto& body = std::get<json>(parsed);
  const auto limit = relayed_limit(body.value("type", ""));
  if (!limit)
    return fail(error_code::unknown_type,
                "no node answers this for another one", "/type");
  if (st.phase != phase::active)
    return fail(error_code::unreachable,
                "node '" + st.peer.name + "' is not a member now");
  auto promise = self->make_response_promise<request_routed>();
  st.frames.call(body, now(self) + *limit + relay_margin,
                 [promise](caf::expected<json> reply) mutable {
                   if (reply)
                     promise.deliver(request_routed{reply->dump(), ""});
                   else
                     promise.deliver(std::move(reply.error()));
                 });
  set_timer(self);
  return promise;
}

actor_state describe(member_self self) {
  const auto& st = self->state;
  const auto silence = now(self) - st.life.last_heard();
  return state_of(
      {{"node", st.peer.name},
       {"uuid", st.peer.uuid},
       {"epoch", st.peer.epoch},
       {"phase", st.phase},
       {"pending_calls", st.frames.calls().pending()},
       {"silent_ms",
        std::chrono::duration_cast<std::chrono::milliseconds>(silence)
            .count()}});
}

void take_over(member_self self, session_admitted accepted,
               cell_coordinator_actor coordinator) {
  auto& st = self->state;
  st.session = std::move(accepted.session);
  st.peer = std::move(accepted.peer);
  st.coordinator = std::move(coordinator);
  st.life = lease{lease_side::coordinator, now(self)};
  st.registration_deadline =
      now(self) + limits::membership::registration_arrival;
  st.frames = session_exchange{[self](std::string text) {
    self->send(self->state.session, send_frame{std::move(text)});
  }};
  self->monitor(st.session);
  self->monitor(st.coordinator);
  self->set_down_handler([self](const caf::down_msg& down) {
    end_member(self, down.source == self->state.session
                         ? "its session has failed"
                         : "the coordinator has stopped");
  });
  self->send(st.session,
             own_session{caf::actor_cast<session_owner_actor>(self)});
  set_timer(self);
}

} // namespace

member_actor::behavior_type member(member_self self, session_admitted accepted,
                                   cell_coordinator_actor coordinator) {
  take_over(self, std::move(accepted), std::move(coordinator));
  return {
      [self](const state_query&) { return describe(self); },
      [self](const resource_query& x) {
        return ask_node<resource_report>(
            self, x, limits::session::resource_query,
            [self](resource_report& report) {
              report.resources.name = self->state.peer.name;
            });
      },
      [self](const figures_query& x) {
        return ask_node<figures_report>(self, x, limits::session::figures);
      },
      [self](const instance_reservation& x) {
        return ask_node<instances_reserved>(self, x,
                                            limits::session::resource_query);
      },
      [self](const instance_deployment& x) {
        return ask_node<instance_deployed>(self, x, limits::task::deployment,
                                           [self](instance_deployed& reply) {
                                             reply.instance.node =
                                                 self->state.peer.name;
                                           });
      },
      [self](const instance_removal& x) {
        return ask_node<instances_removed>(self, x, limits::task::removal);
      },
      [self](const registration_switch& x) {
        return ask_node<switch_accepted>(self, x,
                                         limits::membership::switching);
      },
      [self](const route_request& x) { return relay(self, x); },
      [self](const log_query& x) {
        const auto wait =
            std::clamp(std::chrono::milliseconds{x.wait_ms},
                       std::chrono::milliseconds{0}, limits::log::wait);
        return ask_node<log_excerpt>(self, x, wait + limits::log::session);
      },
      [self](const frame_received& frame) { on_frame(self, frame); },
      [self](const beat_received& beat) { on_beat(self, beat); },
      [self](const session_closed& fact) {
        if (is_from_session(self))
          end_member(self, fact.reason);
      },
      [self](const close_session& wish) { end_member(self, wish.reason); },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
