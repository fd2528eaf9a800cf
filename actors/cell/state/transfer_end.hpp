#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// How a transfer ends. Each does nothing when it has ended already.
namespace roscell {

/// Writes the end down and tells all who wait how it went. Of what has failed
/// it is told that tasks have been terminated nevertheless.
void end_transfer(coordinator_pointer self, const std::string& id,
                  transfer_state state, const std::string& reason,
                  const completion& how);

/// The node stays a member: its row is active again, or lost if it is away.
void call_off_transfer(coordinator_pointer self, const std::string& id,
                       const failure& why);

} // namespace roscell
