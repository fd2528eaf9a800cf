#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/session/limits.hpp"
#include "actors/session/member/member.hpp"
#include "actors/session/session_calls.hpp"
#include "actors/session/session_exchange.hpp"

#include <utility>
#include <variant>

namespace roscell::member_steps {

namespace {

using phase = member_phase;

void refuse_call(self_pointer self, uint64_t id, const failure& why) {
  self->state.frames.answer(id, error_reply(why));
}

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

void on_row_refused(self_pointer self, uint64_t id, const caf::error& why) {
  const auto reason = to_failure(why);
  refuse_call(self, id, reason);
  end_member(self, reason.message);
}

/// The node does not have to hear of an instance twice if the session ends: it
/// registers anew then.
void on_late_start_failed(self_pointer self, const instance_spec& spec,
                          const caf::error& error) {
  const auto why = to_failure(error);
  if (why.code == error_code::unreachable)
    return;
  instance_changed event;
  event.instance.spec = spec;
  event.instance.node = self->state.peer.name;
  event.instance.state = instance_state::failed;
  event.instance.since_unix_ms = unix_now_ms();
  event.instance.reason = why.message;
  self->send(self->state.coordinator, std::move(event));
}

void start_late(self_pointer self, const instance_spec& spec) {
  self->state.frames.call(message_json(instance_deployment{spec}),
                          self->clock().now() + limits::task::deployment,
                          [self, spec](const caf::expected<json>& reply) {
                            if (!reply)
                              on_late_start_failed(self, spec, reply.error());
                          });
  set_timer(self);
}

void on_row(self_pointer self, uint64_t id, node_registered reply) {
  auto& st = self->state;
  // It has said meanwhile that it goes.
  if (st.phase != phase::registering)
    return;
  st.phase = phase::active;
  const auto late = take_long_starts(reply);
  st.frames.answer(id, message_json(reply));
  for (const auto& spec : late)
    start_late(self, spec);
}

void ask_for_row(self_pointer self, uint64_t id, node_registration request) {
  auto& st = self->state;
  st.phase = phase::registering;
  st.announced = true;
  set_name(request, st.peer.name);
  self->request(st.coordinator, limits::membership::row,
                register_node{std::move(request),
                              caf::actor_cast<member_actor>(self)})
      .then(
          [self, id](node_registered& reply) {
            on_row(self, id, std::move(reply));
          },
          [self, id](const caf::error& why) { on_row_refused(self, id, why); });
}

void on_registration(self_pointer self, uint64_t id, const json& body) {
  auto& st = self->state;
  auto request = decode<node_registration>(body);
  if (auto* why = std::get_if<failure>(&request))
    return refuse_call(self, id, *why);
  if (st.phase != phase::awaiting)
    return refuse_call(
        self, id, {error_code::conflict, "this session is registered already"});
  auto& registration = std::get<node_registration>(request);
  if (is_proven(registration.identity, st.peer))
    return ask_for_row(self, id, std::move(registration));
  refuse_call(self, id,
              {error_code::unauthorized,
               "the registration is not of the node that opened the session",
               "/identity"});
  end_member(self, "it registered with another identity than it proved");
}

void on_departure(self_pointer self, uint64_t id, const json& body) {
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
void on_slot_request(self_pointer self, uint64_t id, const json& body) {
  auto& st = self->state;
  auto request = decode<place_request>(body);
  if (auto* why = std::get_if<failure>(&request))
    return refuse_call(self, id, *why);
  auto& x = std::get<place_request>(request);
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
void on_forwarded(self_pointer self, uint64_t id, const json& body,
                  std::chrono::milliseconds limit) {
  self->request(self->state.coordinator, limit,
                route_request{body.dump(), "", "node " + self->state.peer.name})
      .then(
          [self, id](const request_routed& reply) {
            self->state.frames.answer(id, body_of(reply));
          },
          [self, id](const caf::error& why) {
            refuse_call(self, id, to_failure(why));
          });
}

/// The node's engine lacks an image. Who it is for is known by its session.
void on_image_request(self_pointer self, uint64_t id, const json& body) {
  auto request = decode<image_request>(body);
  if (auto* why = std::get_if<failure>(&request))
    return refuse_call(self, id, *why);
  auto& x = std::get<image_request>(request);
  x.node = self->state.peer.name;
  self->request(self->state.coordinator, limits::image::offer, x)
      .then(
          [self, id](const image_offered& reply) {
            self->state.frames.answer(id, message_json(reply));
          },
          [self, id](const caf::error& why) {
            refuse_call(self, id, to_failure(why));
          });
}

} // namespace

void on_request(self_pointer self, uint64_t id, const session_inquiry& x) {
  const auto type = x.type();
  if (type == place_request::type && self->state.phase == phase::awaiting)
    return on_slot_request(self, id, x.body);
  if (type == node_registration::type)
    return on_registration(self, id, x.body);
  if (type == node_departure::type && self->state.phase == phase::registering)
    return on_departure(self, id, x.body);
  if (self->state.phase != phase::active) {
    refuse_call(self, id,
                {error_code::conflict, "this session has no registered node"});
    if (self->state.phase == phase::awaiting)
      end_member(self, "its first request was no registration");
    return;
  }
  if (type == node_departure::type)
    return on_departure(self, id, x.body);
  if (type == image_request::type)
    return on_image_request(self, id, x.body);
  if (const auto waits = forwarding_of(type))
    return on_forwarded(self, id, x.body, waits->coordinator);
  refuse_call(
      self, id,
      {error_code::unknown_type, "a member may not ask for this", "/type"});
}

void on_notice(self_pointer self, const json& body) {
  auto& st = self->state;
  if (st.phase != phase::active)
    return;
  const auto type = body.value("type", "");
  if (type == instance_changed::type) {
    auto event = decode<instance_changed>(body);
    if (auto* x = std::get_if<instance_changed>(&event)) {
      x->instance.node = st.peer.name;
      self->send(st.coordinator, *x);
    }
  } else if (type == skills_changed::type) {
    auto event = decode<skills_changed>(body);
    if (auto* x = std::get_if<skills_changed>(&event))
      self->send(st.coordinator,
                 member_skills_changed{st.peer.uuid,
                                       caf::actor_cast<member_actor>(self),
                                       std::move(*x)});
  }
}

} // namespace roscell::member_steps
