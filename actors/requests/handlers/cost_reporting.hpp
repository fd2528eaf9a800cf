#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/insight/node_cost.hpp"

namespace roscell {

/// What this node costs; of a coordinator, if that is wanted, what each node of
/// its cell does. A node that cannot be asked has a problem instead.
void report_cost(const request_context& context, cost_query query,
                 outcome<cost_report> done);

/// As many as a report has room for.
constexpr size_t max_costed_nodes = 1024;

} // namespace roscell
