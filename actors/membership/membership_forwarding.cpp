#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/membership/membership_steps.hpp"
#include "actors/session/session_exchange.hpp"
#include "dds/server_addresses.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"

#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

request_routed refusal(const failure& why) {
  return {error_reply(why).dump(-1, ' ', false, json::error_handler_t::replace),
          to_string(why.code)};
}

failure no_coordinator(const membership_status& st, const std::string& type) {
  const auto& rows = st.report.rows();
  const auto& me = st.config.identity.name;
  failure why{error_code::unreachable,
              "a coordinator answers '" + type + "', and node '" + me
                  + "' is in no cell now",
              "", "`roscell status` shows why"};
  if (st.state == node_state::orphaned)
    why.message = "the coordinator of cell '" + st.cell + "', which answers '"
                  + type + "', is away";
  if (!rows.empty() && !rows.front().problem.empty())
    why.message += ": " + rows.front().problem;
  return why;
}

/// What must be asked where it is answered.
failure not_passed_on(const membership_status& st, const std::string& type) {
  return {
      error_code::unknown_type,
      "a member does not pass '" + type + "' on to its coordinator", "/type",
      "send it to the coordinator of cell '" + st.cell + "' at " + st.address};
}

/// The session ended before the answer came.
failure coordinator_gone(const membership_status& st,
                         const std::string& reason) {
  return {error_code::unreachable,
          "the coordinator of cell '" + st.cell + "' at " + st.address
              + " has not answered: " + reason,
          "",
          "is its host up, and its process not stopped (`ps -C roscell -o "
          "pid,stat,args` shows a T then)? `roscell status` shows when it is "
          "back; ask again then"};
}

/// What a coordinator's answer lacks: where else one may ask.
failure with_place(const membership_status& st, failure why) {
  if (why.hint.empty()
      && (why.code == error_code::conflict || why.code == error_code::timeout))
    why.hint = "ask the coordinator itself, at " + st.address;
  return why;
}

void deliver(const membership_status& st, const caf::expected<json>& reply,
             caf::typed_response_promise<request_routed> promise) {
  if (reply) {
    promise.deliver(request_routed{reply->dump(), ""});
    return;
  }
  const auto why = to_failure(reply.error());
  promise.deliver(refusal(st.session ? with_place(st, why)
                                     : coordinator_gone(st, why.message)));
}

} // namespace

caf::result<request_routed> pass_on(self_pointer self,
                                    const route_request& request) {
  auto& st = self->state;
  auto parsed = parse_document(request.text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return refusal(*why);
  const auto& body = std::get<json>(parsed);
  const auto type = body.value("type", "");
  if (st.phase != phase::joined)
    return refusal(no_coordinator(st, type));
  const auto waits = forwarding_of(type);
  if (!waits)
    return refusal(not_passed_on(st, type));
  auto promise = self->make_response_promise<request_routed>();
  st.frames.call(body, self->clock().now() + waits->member,
                 [self, promise](const caf::expected<json>& reply) {
                   deliver(self->state, reply, promise);
                 });
  set_timer(self);
  return promise;
}

caf::result<image_offered> ask_for_image(self_pointer self,
                                         image_request request) {
  auto& st = self->state;
  if (st.phase != phase::joined)
    return to_error(no_coordinator(st, image_request::type));
  if (!st.gives_builds)
    return fail(error_code::conflict,
                "the coordinator of cell '" + st.cell
                    + "' is of a version that passes no images on");
  request.node = st.config.identity.name;
  auto promise = self->make_response_promise<image_offered>();
  st.frames.call(
      message_json(request), self->clock().now() + limits::image::offer_session,
      [promise](caf::expected<json> reply) mutable {
        auto offer =
            reply ? reply_as<image_offered>(*reply)
                  : caf::expected<image_offered>{std::move(reply.error())};
        if (offer)
          promise.deliver(std::move(*offer));
        else
          promise.deliver(std::move(offer.error()));
      });
  set_timer(self);
  return promise;
}

namespace {

void on_served(self_pointer self, const discovery_place& place,
               const programs_served& reply) {
  auto& st = self->state;
  if (!st.programs || !(st.programs->place == place))
    return;
  st.programs->address = reply.address;
  publish_environment(self);
  if (st.state == node_state::member)
    store_membership(self);
}

/// Without it programs use the coordinator's server: slower to find each other
/// when the coordinator is away, but no reason to leave the cell.
void on_unserved(self_pointer self, const caf::error& why) {
  publish_event(self, events::edge_problem,
                {{"message", "this node's own discovery server: "
                                 + to_failure(why).message}});
  publish_environment(self);
}

void ask_to_serve(self_pointer self, uint16_t port, bool remote_is_there,
                  bool tells_anew = false) {
  auto& st = self->state;
  const auto place = st.programs->place;
  self->request(st.parts.discovery, limits::local::part,
                serve_programs{place, port, remote_is_there, tells_anew})
      .then([self,
             place](const programs_served& x) { on_served(self, place, x); },
            [self](const caf::error& why) { on_unserved(self, why); });
}

} // namespace

void publish_environment(self_pointer self) {
  self->send(self->state.parts.supervisor,
             use_environment{program_environment(self->state)});
}

uint16_t program_port(const membership_status& st) {
  const auto at =
      st.programs ? parse_socket_address(st.programs->address) : std::nullopt;
  return at ? at->port : 0;
}

void serve_programs_of(self_pointer self, const node_registered& reply) {
  auto& st = self->state;
  // Nobody has to be looked for any more.
  self->send(st.parts.discovery, forget_coordinator{});
  if (reply.discovery.empty()) {
    stop_programs(self);
    return publish_environment(self);
  }
  const auto& place = reply.discovery.front();
  const auto port = program_port(st);
  if (!st.programs || !(st.programs->place == place))
    st.programs = program_service{place, reply.cell_uuid, {}};
  st.programs->cell_uuid = reply.cell_uuid;
  ask_to_serve(self, port, true, reply.tells_anew);
}

void resume_programs(self_pointer self) {
  auto& st = self->state;
  if (!st.stored || st.stored->discovery.empty())
    return publish_environment(self);
  st.programs =
      program_service{st.stored->discovery.front(), st.stored->server_cell, {}};
  ask_to_serve(self, st.stored->discovery_port, false);
}

void let_remote_rest(self_pointer self) {
  if (self->state.programs)
    ask_to_serve(self, program_port(self->state), false);
}

void stop_programs(self_pointer self) {
  auto& st = self->state;
  if (!std::exchange(st.programs, std::nullopt))
    return;
  self->send(st.parts.discovery, stop_serving{});
  publish_environment(self);
}

std::map<std::string, std::string>
program_environment(const membership_status& st) {
  if (!st.programs || st.programs->address.empty())
    return {};
  const auto& place = st.programs->place;
  return {{"ROS_DOMAIN_ID", std::to_string(place.domain_id)},
          {"ROS_DISCOVERY_SERVER",
           ros_discovery_server(static_cast<uint8_t>(place.server_id),
                                st.programs->address)}};
}

} // namespace roscell::membership_steps
