#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/messages.hpp"
#include "roscell/node.hpp"

#include <caf/actor_system.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

/// What a program asks an embedded node by plain calls. They wait on the thread
/// of the caller, and throw node_error.
namespace roscell::embedding {

/// Who is asked.
struct task_door {
  caf::actor_system* system = nullptr;
  request_router_actor router;
  actor_context context;
};

/// The document that answers a request; a refusal is thrown.
json ask_node(const task_door& door, const json& request,
              std::chrono::milliseconds limit);

/// @param request a task request, as JSON or YAML; its type may be left out.
/// Returns the name of the task.
std::string run_task(const task_door& door, const std::string& request,
                     std::chrono::milliseconds limit);

/// "gone" if the cell has no such task.
task_status status_of_task(const task_door& door, const std::string& task,
                           std::chrono::milliseconds limit);

/// The same of the rows of an answer; "gone" if the task is not among them.
task_status status_of(const std::vector<task_row>& rows,
                      const std::string& task);

/// Watches a task; ended by the end of what is returned.
std::shared_ptr<task_watch::impl>
watch_task(const task_door& door, const std::string& task,
           std::function<void(const task_status&)> on_change);

} // namespace roscell::embedding
