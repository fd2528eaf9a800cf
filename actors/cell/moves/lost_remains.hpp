#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <optional>
#include <string>

/// What may still run, or begin anew, on a node that is away, so that nothing
/// takes its place: a step that may move, until its fence has ended it, and one
/// that its host starts alone, for as long as that may be switched on.
namespace roscell {

/// Whether a step may be placed anew where its node is lost.
bool may_move(const instance_spec& x);

/// Whether its host may start it without the coordinator.
bool starts_alone(const instance_spec& x);

/// Whether it is there and no task wants it, where it may go on for a while, or
/// begin anew.
bool is_left_over(const cell_coordinator_state& st, const instance_row& row);

/// How long the fence may let an instance run on where its node is away; none
/// if it surely does not, or its node can be told to end it.
std::optional<std::chrono::milliseconds>
may_run_on(coordinator_pointer self, const std::string& instance);

/// Why a task must not be begun yet: a step of its name that was lost, and that
/// nobody wants any more, may still run.
/// @param force Hosts that would start one alone are off, somebody says.
std::optional<failure> remains_of(coordinator_pointer self,
                                  const std::string& task, bool force);

/// Why nothing takes the place of an instance that its host starts alone.
failure may_start_alone(const std::string& instance, const std::string& node);

} // namespace roscell
