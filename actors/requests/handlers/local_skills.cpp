#include "actors/requests/handlers/local_skills.hpp"

#include "actors/core/answer_limits.hpp"

#include <utility>

namespace roscell {

void list_local_skills(const request_context& context, skill_query query,
                       outcome<skill_list> done) {
  ask<node_description>(
      context, context.services->node, limits::local::answer, node_query{},
      done, [done, query](const node_description& node) {
        skill_list result;
        for (const auto& skill : node.skills)
          if (query.operation.empty()
              || skill.descriptor.operation == query.operation)
            result.skills.push_back(
                {skill, {node.identity.name}, {skill.added_unix_ms}});
        for (const auto& problem : node.refused_skills)
          result.refused.push_back({node.identity.name, problem});
        done.deliver(std::move(result));
      });
}

} // namespace roscell
