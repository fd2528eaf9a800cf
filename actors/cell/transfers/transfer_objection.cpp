#include "actors/cell/transfers/transfer_start.hpp"

#include "messages/failure.hpp"

namespace roscell {

namespace {

std::string list_instances(const std::vector<instance_spec>& specs) {
  std::string result;
  for (const auto& x : specs)
    result += (result.empty() ? "'" : ", '") + x.instance + "'";
  return result;
}

/// A row that is on its way in or out. One whose transfer is unresolved may be
/// let go while the node is away: nobody else can settle that.
std::optional<failure> objection_of_row(const cell_coordinator_state& st,
                                        const registry_entry& entry) {
  const auto& row = entry.row;
  const auto name = "node '" + row.identity.name + "'";
  if (row.state == row_state::reserved)
    return failure{error_code::conflict, name + " is reserved", "/node",
                   "wait until it has joined"};
  const auto id = st.transfers.holder_of(row.identity.uuid);
  const bool settles_by_itself =
      st.transfers.is_busy(row.identity.uuid) || entry.member;
  if (id.empty() || !settles_by_itself)
    return std::nullopt;
  return failure{error_code::conflict, name + " is departing", "/node",
                 "its transfer is '" + id + "'"};
}

} // namespace

std::optional<failure> objection_to(coordinator_pointer self,
                                    const transfer_order& order) {
  auto& st = self->state;
  const auto name = "node '" + order.node + "'";
  const auto* entry = st.registry.find_name(order.node);
  if (!entry)
    return failure{error_code::unknown_node, "no " + name + " is in any cell",
                   "/node", "`roscell nodes` lists those of a cell"};
  if (entry->row.identity.uuid == st.setup.self.uuid)
    return failure{error_code::conflict,
                   name + " coordinates cell '" + st.setup.cell
                       + "': a coordination node cannot leave its cell",
                   "/node"};
  if (order.target == st.setup.cell)
    return failure{error_code::conflict,
                   name + " is in cell '" + st.setup.cell + "' already",
                   "/target"};
  if (auto why = objection_of_row(st, *entry))
    return why;
  if (!order.target.empty() && !entry->member)
    return failure{error_code::unreachable,
                   name + " is " + std::string{to_word(entry->row.state)},
                   "/node", "try again when it is back"};
  if (!order.target.empty() && !st.peers.find_cell(order.target))
    return failure{error_code::unknown_cell,
                   "no coordinator of a cell '" + order.target
                       + "' is within reach",
                   "/target", "`roscell cells` lists them"};
  return objection_to_instances(st, order);
}

std::optional<failure> objection_to_instances(const cell_coordinator_state& st,
                                              const transfer_order& order) {
  const auto specs = st.deployments.bound_to(order.node);
  if (order.instances != instance_policy::refuse || specs.empty())
    return std::nullopt;
  return failure{error_code::conflict,
                 "node '" + order.node + "' runs, or is being sent, "
                     + list_instances(specs),
                 "/instances",
                 "say \"terminate\" or \"reschedule\" to let it go"};
}

} // namespace roscell
