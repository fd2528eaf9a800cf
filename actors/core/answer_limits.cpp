#include "actors/core/answer_limits.hpp"

#include "messages/exec.hpp"
#include "messages/insight/examination.hpp"
#include "messages/insight/node_cost.hpp"
#include "messages/insight/reach.hpp"
#include "messages/node.hpp"
#include "messages/secret.hpp"
#include "messages/site.hpp"

#include <algorithm>
#include <array>

namespace roscell {

namespace {

/// What a node answers about itself from what it knows or keeps,
constexpr std::array<std::string_view, 12> queries{node_query::type,
                                                   actor_query::type,
                                                   cost_query::type,
                                                   reach_opening::type,
                                                   exec_input::type,
                                                   exec_output_query::type,
                                                   secret_setting::type,
                                                   site_query::type,
                                                   identity_request_query::type,
                                                   identity_setting::type,
                                                   revocation_setting::type,
                                                   audit_query::type};

/// and what it has to find out.
constexpr std::array<std::string_view, 3> looks{
    reach_query::type, examination_query::type, exec_request::type};
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
