#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <vector>

/// What the CELL COORDINATOR knows of the rest of its site. Other coordinators
/// are in `st.peers`: it opens sessions to those that are announced, and takes
/// what they report as claims about nodes. Nodes without a cell are in
/// `st.unassigned_nodes`. Both lists are what `roscell cells` and `nodes` show.
namespace roscell {

/// Another coordinator has opened a session.
void on_peer_admitted(coordinator_pointer self, const session_admitted& event);

void on_peer_opened(coordinator_pointer self, const peer_opened& event);
void on_peer_lost(coordinator_pointer self, const peer_lost& event);

/// The actor of a peer has died.
void on_peer_down(coordinator_pointer self, const caf::actor_addr& gone);

void on_peer_status_reported(coordinator_pointer self,
                             const peer_status_reported& event);
void on_peer_changed(coordinator_pointer self, const peer_changed& event);

/// Tries the sessions that are due.
void open_due_peers(coordinator_pointer self);

// What is announced on the public domain, where anybody may announce anything,
// is a hint about whom to ask.

/// Announces the cell, and is told of others from then on.
void appear(coordinator_pointer self);

void on_presence_seen(coordinator_pointer self, const node_presence& who);
void on_presence_gone(coordinator_pointer self, const node_presence& who);

/// Asks nodes whose announcement contradicts a row of this cell to prove it.
void ask_due_proofs(coordinator_pointer self);

/// The nodes that are in no cell, as far as is known here. Of those that are
/// announced no more only the ones that no cell has a row for.
std::vector<unassigned_node>
list_unassigned_nodes(const cell_coordinator_state& st);

/// Every cell that is known, the own one first.
std::vector<cell_row> list_cells(const cell_coordinator_state& st);

} // namespace roscell
