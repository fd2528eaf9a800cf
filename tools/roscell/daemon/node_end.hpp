#pragma once

#include "actors/node/spawn_node.hpp"
#include "tools/roscell/daemon/stop_signals.hpp"
#include "tools/roscell/exit_code.hpp"

#include <caf/actor_system.hpp>

#include <chrono>

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

} // namespace roscell::cli
