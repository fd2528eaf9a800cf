#include "actors/cell/state/coordinator_publish.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/member_servers.hpp"

namespace roscell {

void publish(coordinator_pointer self,
             const std::vector<std::string>& changed_uuids,
             const std::vector<std::string>& gone_uuids) {
  auto& st = self->state;
  cell_changed change;
  change.size = static_cast<int64_t>(st.registry.size());
  change.gone = gone_uuids;
  for (const auto& uuid : changed_uuids)
    if (const auto* entry = st.registry.find_uuid(uuid))
      change.changed.push_back(claim_of(entry->row));
  st.peers.for_each_session([&](const std::string&, const peer_entry& peer) {
    self->send(peer.actor, change);
  });
}

void drop_row(coordinator_pointer self, const std::string& uuid) {
  auto& st = self->state;
  const auto* entry = st.registry.find_uuid(uuid);
  if (!entry)
    return;
  if (entry->row.state != row_state::reserved)
    persist_record(self, {"members", uuid, ""});
  st.deployments.forget_node(entry->row.identity.name);
  follow_member_server(self, *entry, server_contact::gone);
  st.registry.erase(uuid);
  publish(self, {}, {uuid});
}

} // namespace roscell
