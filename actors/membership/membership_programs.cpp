#include "actors/core/answer_limits.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/membership/membership_steps.hpp"
#include "dds/server_ids.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell::membership_steps {

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
