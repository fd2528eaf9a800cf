#include "actors/cell/transfers/named_node.hpp"

#include <map>
#include <utility>

namespace roscell {

namespace {

/// The nodes of that name in other cells, each once: of several claims of one
/// node the one with the highest epoch is right.
std::map<std::string, named_node>
nodes_elsewhere(const cell_coordinator_state& st, const std::string& node) {
  std::map<std::string, named_node> result;
  st.peers.for_each_session([&](const std::string&, const peer_entry& peer) {
    for (const auto& [uuid, claim] : peer.members) {
      if (!peer.reported || claim.name != node)
        continue;
      auto& known = result[uuid];
      if (!known.holder || known.claim.epoch < claim.epoch)
        known = {peer.actor, claim, peer.status.place.cell, {}};
    }
  });
  return result;
}

constexpr auto name_the_cell =
    "name its cell: \"cell\" in the request, `--cell` on the command line";

failure in_several(const std::string& node,
                   const std::map<std::string, named_node>& found) {
  std::string cells;
  for (const auto& [uuid, x] : found)
    cells += (cells.empty() ? "'" : ", '") + x.cell + "'";
  return {error_code::conflict,
          "several cells have a node '" + node + "': " + cells, "/node",
          name_the_cell};
}

/// A request that is sent twice must not take another node the second time.
failure gone_from_here(const transfer_row& gone, const std::string& cell) {
  return {error_code::unknown_node,
          "cell '" + gone.from + "' has no node '" + gone.node
              + "' any more: it went with transfer '" + gone.transfer
              + "'; the one in cell '" + cell + "' was not named",
          "/node", name_the_cell};
}

/// A transferred node is followed to where it went; a released one is not.
bool is_another(const transfer_row& gone, const named_node& found) {
  return gone.to.empty() || gone.uuid != found.claim.uuid;
}

named_node find_in_cell(const cell_coordinator_state& st,
                        const std::string& cell) {
  if (const auto* peer = st.peers.find_cell(cell))
    return {peer->actor, {}, cell, {}};
  return {{},
          {},
          {},
          {error_code::unknown_cell,
           "no coordinator of a cell '" + cell + "' is within reach", "/cell",
           "`roscell cells` lists them"}};
}

} // namespace

named_node find_elsewhere(const cell_coordinator_state& st,
                          const std::string& node) {
  const auto found = nodes_elsewhere(st, node);
  if (found.size() > 1)
    return {{}, {}, {}, in_several(node, found)};
  return found.empty() ? named_node{} : found.begin()->second;
}

named_node find_named_node(const cell_coordinator_state& st,
                           const std::string& node, const std::string& cell) {
  if (!cell.empty() && cell != st.setup.cell)
    return find_in_cell(st, cell);
  if (!cell.empty() || st.registry.find_name(node))
    return {};
  auto found = find_elsewhere(st, node);
  const auto* gone = st.transfers.find_gone(node);
  if (found.holder && gone && is_another(*gone, found))
    return {{}, {}, {}, gone_from_here(*gone, found.cell)};
  return found;
}

} // namespace roscell
