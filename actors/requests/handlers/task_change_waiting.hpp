#pragma once

#include "actors/requests/request_context.hpp"
#include "messages/task.hpp"

#include <string>

namespace roscell {

/// How a task stands, once that is something else than the asker knows, or when
/// his wait is over. So a task is watched without polling, over any number of
/// hops. Errors: conflict (too many wait).
void await_task_change(const request_context& context, task_change_query query,
                       outcome<task_change> done);

/// What of a task makes an asker of its changes hear of it: the states and
/// places of its instances, not their metrics.
std::string mark_of(const task_description& task);

} // namespace roscell
