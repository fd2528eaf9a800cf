#pragma once

#include "actors/requests/request_context.hpp"

/// What a coordinator remembers of its own work.
namespace roscell {

/// `unknown_task` when no decision about the task is kept.
void tell_placement(const request_context& context, task_placement_query query,
                    outcome<task_placement> done);

void list_traces(const request_context& context, request_trace_query query,
                 outcome<request_traces> done);

} // namespace roscell
