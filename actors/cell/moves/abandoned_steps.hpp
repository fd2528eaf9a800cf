#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <optional>
#include <string>

/// How the CELL COORDINATOR places steps anew whose node is lost, where they
/// say "move". Never two at once: the lost node's shims end theirs a lease
/// before (docs/protocols.md, "The fence").
namespace roscell {

/// A node is away since its last word.
void abandon_steps_of(coordinator_pointer self, const std::string& node,
                      const std::string& uuid,
                      std::chrono::steady_clock::time_point since);

/// Nothing is known of any node but this one: the coordinator has just started.
void abandon_steps_of_all(coordinator_pointer self);

/// A node is back and has been told what to keep.
void find_steps_of(coordinator_pointer self, const node_registration& node);

/// Whether another machine than the one that may still run it has the name of
/// its node now.
bool is_elsewhere(const cell_coordinator_state& st, const std::string& instance,
                  const std::string& uuid);

/// A step is not started on its own node, which wants it, since another
/// instance of it may run: it is placed once that has ended.
void abandon_own_start(coordinator_pointer self, const deployment& x,
                       const std::string& uuid);

/// Places anew what has been lost for long enough.
///
/// Until it is placed its node may come back, its task be terminated, and what
/// it is placed on be lost: each part asks whether the step is still lost.
void move_abandoned_steps(coordinator_pointer self);

/// For what a step waits whose node is away, in a sentence.
std::string wait_of_lost(const cell_coordinator_state& st,
                         const instance_row& row);

} // namespace roscell
