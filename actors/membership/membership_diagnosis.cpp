#include "actors/core/answer_limits.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/membership/join_report.hpp"
#include "actors/membership/limits.hpp"
#include "actors/membership/membership_steps.hpp"
#include "messages/event_kinds.hpp"

#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

void find_at(self_pointer self, const socket_address& server) {
  auto& st = self->state;
  st.server_address = server.address;
  self->request(st.parts.discovery, limits::local::part,
                find_coordinator{to_string(server)})
      .then([](caf::ok_atom) {},
            [self, attempt = st.attempt](const caf::error& why) {
              if (is_current(self, attempt, phase::searching))
                on_error(self, why);
            });
}

void find_by_name(self_pointer self, const socket_address& server) {
  self->request(self->state.parts.diagnoser,
                limits::membership::naming + limits::local::part,
                resolve_host{server.address})
      .then(
          [self, server,
           attempt = self->state.attempt](const host_resolved& reply) {
            if (is_current(self, attempt, phase::searching))
              find_at(self, {reply.address, server.port});
          },
          [self, attempt = self->state.attempt](const caf::error& error) {
            if (!is_current(self, attempt, phase::searching))
              return;
            const auto why = to_failure(error);
            attempt_failed(self, why.message, why.hint);
          });
}

void on_server_probed(self_pointer self, const server_probed& found) {
  auto& st = self->state;
  const auto server = parse_host_address(st.wanted);
  if (!server)
    return;
  const auto why = diagnose({st.wanted, server->port}, found);
  st.diagnosed = true;
  complain(self, why.problem, why.hint);
}

void check_server(self_pointer self) {
  auto& st = self->state;
  const auto server = parse_host_address(st.wanted);
  // A name that has not been resolved yet has nothing to look at.
  if (!server || st.server_address.empty())
    return;
  self->request(st.parts.diagnoser, limits::local::part,
                probe_server{st.server_address, server->port})
      .then(
          [self, attempt = st.attempt](const server_probed& found) {
            if (is_current(self, attempt, phase::searching))
              on_server_probed(self, found);
          },
          [](const caf::error&) {
            // The end of the search says that nobody answers.
          });
}

/// A node that takes any place has seen nobody who has one.
void publish_solitude(self_pointer self) {
  auto& st = self->state;
  const auto why = diagnose_solitude(st.config.public_domain);
  complain(self, why.problem, why.hint);
  st.look_due = st.report.next();
  set_timer(self);
}

} // namespace

void find_server(self_pointer self) {
  auto& st = self->state;
  st.server_address.clear();
  st.diagnosed = false;
  st.look_due = self->clock().now() + limits::membership::silence;
  const auto server = parse_host_address(st.wanted);
  if (!server)
    return attempt_failed(self, "'" + st.wanted
                                    + "' is not an address like "
                                      "10.0.0.1:11811");
  if (is_ipv4(server->address))
    find_at(self, *server);
  else
    find_by_name(self, *server);
}

bool is_looking(const membership_status& st) {
  if (st.look_due == membership_status::time_point::max())
    return false;
  return st.phase == phase::searching
         || (st.phase == phase::resting && st.seeking);
}

void seek_coordinators(self_pointer self) {
  auto& st = self->state;
  st.look_due = membership_status::time_point::max();
  if (st.phase == phase::searching)
    check_server(self);
  else
    publish_solitude(self);
}

void complain(self_pointer self, const std::string& problem,
              const std::string& hint) {
  auto& st = self->state;
  if (!st.report.note(problem, hint, self->clock().now()))
    return;
  const auto& row = st.report.rows().front();
  json data{{"reason", problem}, {"attempts", row.attempts}};
  if (!row.address.empty())
    data["discovery_server"] = row.address;
  if (!hint.empty())
    data["hint"] = hint;
  publish_event(self, events::join_failed, std::move(data));
}

} // namespace roscell::membership_steps
