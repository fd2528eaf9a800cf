#pragma once

#include "actors/node/spawn_node.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/service_signals.hpp"

#include <caf/actor_system.hpp>

#include <chrono>
#include <functional>
#include <string>

/// The ends of a node of this process. Each waits until all of its parts have
/// ended, but not for long, and not at all after another signal: then the
/// process ends at once, as threads that hang must not keep it.
namespace roscell::cli {

/// Gives away what runs here, for as long as it was told to try that, and not
/// after another signal. What is left goes on running.
void empty_node(caf::actor_system& system, const running_node& node,
                stop_signals& signals, std::chrono::milliseconds limit);

/// It leaves its cell.
void stop_in_order(caf::actor_system& system, const running_node& node,
                   stop_signals& signals);

/// It stays in its cell, as after a crash: it is about to be made anew, or
/// cannot say anything any more. `code` is that of the process, should it end.
void halt(caf::actor_system& system, const running_node& node,
          stop_signals& signals, exit_code code);

/// It has failed.
void await_failed(caf::actor_system& system, const running_node& node,
                  stop_signals& signals);

/// Has the coordinator move every instance away from this node, and calls
/// `done` once none is left, or it cannot be done, with the reason. Called in
/// an actor, at most once.
void drain_first(caf::actor_system& system, const running_node& node,
                 std::function<void(const std::string& problem)> done);

/// The node takes instances again, when it is back. Blocks until the
/// coordinator knows, for some seconds at most.
void undrain(caf::actor_system& system, const running_node& node);

} // namespace roscell::cli
