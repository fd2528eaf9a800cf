#include "actors/cell/state/member_servers.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/delay.hpp"

#include <chrono>
#include <utility>

namespace roscell {

namespace {

constexpr std::chrono::seconds silent_host{60};

} // namespace

void meet_member_server(coordinator_pointer self, int64_t server_id,
                        bool tells_anew, std::function<void()> then) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || server_id < 0)
    return then();
  follow_server request;
  request.server_id = server_id;
  request.tells_anew = tells_anew;
  self->request(discovery, limits::local::part, request)
      .then([then](caf::ok_atom) { then(); },
            [then](const caf::error&) { then(); });
}

void follow_member_server(coordinator_pointer self, const registry_entry& entry,
                          server_contact contact) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || entry.server_id < 0)
    return;
  follow_server request;
  request.server_id = entry.server_id;
  request.contact = contact;
  caf::anon_send(discovery, request);
}

void doubt_silent_host(coordinator_pointer self, const registry_entry& entry) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || entry.server_id < 0)
    return;
  follow_server request;
  request.server_id = entry.server_id;
  request.contact = server_contact::settled;
  send_lasting_actor_later(discovery, silent_host, request);
}

} // namespace roscell
