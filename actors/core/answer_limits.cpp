#include "actors/core/answer_limits.hpp"

#include "messages/insight/examination.hpp"
#include "messages/insight/node_cost.hpp"
#include "messages/insight/reach.hpp"
#include "messages/node.hpp"

#include <algorithm>
#include <array>

namespace roscell {

namespace {

/// What a node answers about itself from what it knows,
constexpr std::array<std::string_view, 4> queries{
    node_query::type, actor_query::type, cost_query::type, reach_opening::type};

/// and what it has to find out.
constexpr std::array<std::string_view, 2> looks{reach_query::type,
                                                examination_query::type};
constexpr std::chrono::seconds look_limit{20};

template <class Names>
bool holds(const Names& names, std::string_view type) {
  return std::find(names.begin(), names.end(), type) != names.end();
}

} // namespace

std::optional<std::chrono::milliseconds> relayed_limit(std::string_view type) {
  if (holds(queries, type))
    return limits::local::answer;
  if (holds(looks, type))
    return look_limit;
  return std::nullopt;
}

} // namespace roscell
