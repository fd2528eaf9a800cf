#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// The states of a transfer, and how it ends.
namespace roscell {

bool is_open(transfer_state x);

void enter_state(cell_transfer& x, transfer_state state, std::string reason);

/// Writes an open transfer down; removes one that has ended.
void store_transfer(coordinator_pointer self, const transfer_row& row);

/// Tells all who wait.
void tell_waiting(cell_transfer& x, const failure* why);

/// The transfer has come to its end, one way or the other.
void end_transfer(coordinator_pointer self, cell_transfer& x,
                  transfer_state state, const std::string& reason,
                  const failure* why);

} // namespace roscell
