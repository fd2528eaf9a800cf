#pragma once

#include "actors/requests/request_context.hpp"

namespace roscell {

/// On a primary node: the skills of this node alone.
void list_local_skills(const request_context& context, skill_query query,
                       outcome<skill_list> done);

} // namespace roscell
