#include "actors/cell/state/doubts.hpp"

namespace roscell {

bool is_in_doubt(const cell_coordinator_state& st, const node_presence& who) {
  const auto* entry = st.registry.find_uuid(who.uuid);
  if (!entry || who.role != "independent")
    return false;
  const auto& row = entry->row;
  // Every registration has an epoch of its own, so one of the row's epoch has
  // come to nothing.
  return row.state != row_state::active && row.state != row_state::reserved
         && who.epoch >= row.identity.epoch;
}

std::chrono::steady_clock::time_point
next_proof(const cell_coordinator_state& st) {
  if (!st.setup.registration)
    return std::chrono::steady_clock::time_point::max();
  return st.unassigned_nodes.next_question(
      [&](const node_presence& who) { return is_in_doubt(st, who); });
}

} // namespace roscell
