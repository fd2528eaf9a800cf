#include "actors/cell/state/node_whereabouts.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/transfer_end.hpp"
#include "messages/failure.hpp"

namespace roscell {

void on_node_elsewhere(coordinator_pointer self, const std::string& uuid,
                       int64_t epoch, const std::string& cell) {
  auto& st = self->state;
  auto* entry = st.registry.find_uuid(uuid);
  if (!entry || entry->row.identity.epoch > epoch)
    return;
  const auto name = entry->row.identity.name;
  const auto transfer = entry->transfer;
  const auto member = entry->member;
  drop_row(self, uuid);
  if (member)
    self->send(member, close_session{"the node is elsewhere"});
  st.context.tell("node_left", name,
                  {{"reason", cell.empty() ? "it is independent"
                                           : "it is in cell '" + cell + "'"},
                   {"size", st.registry.active_count()}});
  const auto i = st.transfers.find(transfer);
  if (i == st.transfers.end() || !is_open(i->second.row.state))
    return;
  auto& x = i->second;
  if (x.row.to == cell)
    return end_transfer(self, x, transfer_state::done, "", nullptr);
  const failure why{error_code::conflict,
                    "node '" + name + "' went elsewhere meanwhile", "/node"};
  end_transfer(self, x, transfer_state::returned, why.message, &why);
}

void on_node_returned(coordinator_pointer self, const std::string& transfer) {
  auto& st = self->state;
  const auto i = st.transfers.find(transfer);
  if (i == st.transfers.end() || !is_open(i->second.row.state))
    return;
  auto& x = i->second;
  const failure why{error_code::unreachable,
                    "node '" + x.row.node + "' could not register with cell '"
                        + x.row.to + "' and has come back",
                    "/target", "see the events of the node"};
  end_transfer(self, x, transfer_state::returned, why.message, &why);
}

} // namespace roscell
