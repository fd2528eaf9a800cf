#include "actors/session/forwarded_requests.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/relayed_requests.hpp"
#include "actors/session/limits.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/formation.hpp"
#include "messages/insight/fresh_cell_query.hpp"
#include "messages/insight/request_trace.hpp"
#include "messages/insight/task_placement.hpp"
#include "messages/instance.hpp"
#include "messages/rebalance.hpp"
#include "messages/task.hpp"
#include "messages/topic.hpp"

#include <array>
#include <string_view>

namespace roscell {

namespace {

/// What the coordinator answers from what it knows.
constexpr std::array<std::string_view, 10> queries{
    fresh_cell_query::type,    cell_query::type,
    cell_list_query::type,     task_query::type,
    task_history_query::type,  task_placement_query::type,
    request_trace_query::type, transfer_query::type,
    topic_query::type,         instance_query::type};

/// What it has to do something for.
constexpr std::array<std::string_view, 7> commands{
    task_request::type,  task_plan_query::type, task_termination::type,
    task_restart::type,  node_drain::type,      node_undrain::type,
    cell_rebalance::type};

/// That whoever waits for the member's answer waits longer than the member.
constexpr std::chrono::seconds log_margin{2};
static_assert(limits::log::wait + limits::log::answer
              < limits::log::stream - log_margin);

template <class Names>
bool holds(const Names& names, const std::string& type) {
  for (const auto& x : names)
    if (x == type)
      return true;
  return false;
}

} // namespace

std::optional<forwarding_limits> forwarding_of(const std::string& type) {
  if (holds(queries, type))
    return forwarding_limits{limits::request::forwarded_query,
                             limits::request::member_query};
  // It may be waited for, by whoever follows a log.
  if (type == log_query::type)
    return forwarding_limits{limits::log::wait + limits::log::answer,
                             limits::log::stream - log_margin};
  if (type == task_change_query::type)
    return forwarding_limits{
        limits::task::change_wait + limits::request::forwarded_query,
        limits::task::change_wait + limits::request::member_query};
  if (holds(commands, type))
    return forwarding_limits{limits::request::forwarded,
                             limits::request::member_request};
  if (const auto node = relayed_limit(type))
    return forwarding_limits{*node + 2 * relay_margin,
                             *node + 3 * relay_margin};
  return std::nullopt;
}

} // namespace roscell
