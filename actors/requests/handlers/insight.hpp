#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/insight/fresh_cell_query.hpp"

/// What a coordinator remembers of its own work, and what its nodes have now.
namespace roscell {

/// `unknown_task` when no decision about the task is kept.
void report_placement(const request_context& context,
                      task_placement_query query, outcome<task_placement> done);

void list_traces(const request_context& context, request_trace_query query,
                 outcome<request_traces> done);

/// A node that does not answer keeps what it has reported last.
void read_resources(const request_context& context, fresh_cell_query,
                    outcome<cell_query> done);
void report_cell(const request_context& context, cell_query query,
                 outcome<cell_description> done);

} // namespace roscell
