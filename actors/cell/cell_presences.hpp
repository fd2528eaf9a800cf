#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <vector>

/// What the CELL COORDINATOR does about what is announced on the public domain,
/// where anybody may announce anything: it is a hint about whom to ask.
namespace roscell {

/// Announces the cell, and hears of others from then on.
void appear(coordinator_pointer self);

void on_presence_seen(coordinator_pointer self, const node_presence& who);
void on_presence_gone(coordinator_pointer self, const node_presence& who);

/// Asks the nodes on whose word a row hangs to prove it.
void ask_due_proofs(coordinator_pointer self);

/// The nodes that are in no cell, as far as is known here. Of those that have
/// fallen silent only the ones that no cell has a row for.
std::vector<unassigned_node>
list_unassigned_nodes(const cell_coordinator_state& st);

/// Every cell that is known, the own one first.
std::vector<cell_row> list_cells(const cell_coordinator_state& st);

} // namespace roscell
