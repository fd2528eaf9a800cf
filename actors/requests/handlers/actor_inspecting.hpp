#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/insight/actor_inspection.hpp"

namespace roscell {

/// Asks each actor of that name or id what it knows, `max_inspected` at most.
/// `unknown_task` when there is none.
void inspect_actors(const request_context& context, actor_query query,
                    outcome<actor_inspection> done);

constexpr size_t max_inspected = 64;

} // namespace roscell
