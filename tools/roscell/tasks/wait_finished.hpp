#pragma once

#include "messages/allocation_report.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <cstdint>
#include <string>

/// How commands wait for what may take long: until all of a task runs, until it
/// has ended by itself, or is gone.
namespace roscell::cli {

/// Number of the last event that the node has told; what follows is not missed.
/// Throws command_error unless the node is a coordinator: others do not hear
/// what becomes of a task.
uint64_t last_event_of_coordinator(const node_client& node);

/// Waits until a task has finished or failed, says so on standard error, and
/// gives the exit code of its first step that failed, 0 if none has.
/// @param begun How its request has found it.
/// @param since As `last_event_of_coordinator` gave it before that.
int wait_until_ended(const node_client& node, const task_accepted& begun,
                     uint64_t since);

/// Waits until all of a degraded task runs, or it has ended, and says on
/// standard error for what. Throws command_error after `limit`.
void wait_until_whole(const node_client& node, const task_accepted& begun,
                      std::chrono::milliseconds limit);

/// Waits until a task that is being terminated is gone.
void wait_until_gone(const node_client& node, const std::string& task,
                     uint64_t since);

} // namespace roscell::cli
