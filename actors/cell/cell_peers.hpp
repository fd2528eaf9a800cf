#pragma once

#include "actors/cell/cell_coordinator.hpp"

#include <string>
#include <vector>

/// What the CELL COORDINATOR does about other coordinators and about nodes that
/// are in no cell.
namespace roscell {

/// Announces the cell, and hears of others from then on.
void appear(coordinator_pointer self);

void on_presence_seen(coordinator_pointer self, const node_presence& who);
void on_presence_gone(coordinator_pointer self, const node_presence& who);

/// A row is not active any more: its node may have said publicly that it is in
/// no cell before that was known.
void on_row_vacated(coordinator_pointer self, const std::string& uuid);

/// Another coordinator has opened a session.
void on_peer_admitted(coordinator_pointer self, const session_admitted& fact);

void on_peer_opened(coordinator_pointer self, const peer_opened& fact);
void on_peer_lost(coordinator_pointer self, const peer_lost& fact);
void on_peer_told(coordinator_pointer self, const peer_told& fact);
void on_peer_changed(coordinator_pointer self, const peer_changed& fact);

/// Tries the sessions that are due.
void open_due_peers(coordinator_pointer self);

/// Another coordinator of that cell with a session; null if there is none.
peer_entry* find_peer(coordinator_pointer self, const std::string& cell);

/// The one that has a row for that node; null if none has.
peer_entry* find_peer_with(coordinator_pointer self, const std::string& node);

/// Every cell that is known, the own one first.
std::vector<cell_row> list_cells(coordinator_pointer self);

/// The visible nodes that are in no cell.
std::vector<free_node> list_free_nodes(coordinator_pointer self);

} // namespace roscell
