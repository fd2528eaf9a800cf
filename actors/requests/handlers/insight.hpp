#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/cell.hpp"
#include "messages/insight/examination.hpp"
#include "messages/insight/node_cost.hpp"

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

/// Asks each actor of that name or id what it knows, `max_inspected` at most.
/// `unknown_task` when there is none.
void inspect_actors(const request_context& context, actor_query query,
                    outcome<actor_inspection> done);

constexpr size_t max_inspected = 64;

/// Has the program look at its host, by a thread of its own. `conflict` where
/// the program cannot, or is looking already.
void check_host(const request_context& context, examination_query query,
                outcome<examination> done);

/// Looks, unless that is being done already: then there is nothing.
std::function<findings()> one_at_a_time(std::function<findings()> look);

/// On a primary node: the skills of this node alone.
void list_local_skills(const request_context& context, skill_query query,
                       outcome<skill_list> done);

/// What this node costs; of a coordinator, if that is wanted, what each node of
/// its cell does. A node that cannot be asked has a problem instead.
void report_cost(const request_context& context, cost_query query,
                 outcome<cost_report> done);

/// As many as a report has room for.
constexpr size_t max_costed_nodes = 1024;

} // namespace roscell
