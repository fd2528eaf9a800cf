#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <string>

/// What the CELL COORDINATOR does when it learns where a node is that it has,
/// or had, a row for.
namespace roscell {

/// An event: the node has this epoch in another cell, or in none if `cell` is
/// empty. Its row here is out of date.
void on_node_elsewhere(coordinator_pointer self, const std::string& uuid,
                       int64_t epoch, const std::string& cell);

/// An event: the node has registered here, maybe in the middle of a transfer.
void on_node_returned(coordinator_pointer self, const std::string& uuid);

/// An event: a node with a departing row has no session any more. It is lost,
/// unless it has been told to go: then where it turns up tells the rest. Gives
/// whether it is lost.
bool fail_departing_node(coordinator_pointer self, registry_entry& entry,
                         const std::string& reason);

/// Tells of a row that has become `lost`.
void publish_node_lost(coordinator_pointer self, const registry_entry& entry);

} // namespace roscell
