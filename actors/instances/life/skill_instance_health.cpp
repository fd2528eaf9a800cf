#include "actors/house/limits.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "schemas/utf8.hpp"

#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// What writes an input, as far as its node has been told.
std::string feeder_of(const io_endpoint& input) {
  if (input.external)
    return "a program that no task has started is to write it";
  return input.from.empty() ? "" : "it is fed by step '" + input.from + "'";
}

health_book book_of(const skill_instance_state& st) {
  std::vector<std::string> feeders;
  for (const auto& input : st.row.spec.input)
    feeders.push_back(feeder_of(input));
  return {st.row.spec, *st.ready_since, std::move(feeders),
          health_verdict{st.row.health, st.row.health_reason}};
}

const char* fact_of(instance_health health) {
  switch (health) {
  case instance_health::starved:
    return "instance_starved";
  case instance_health::unhealthy:
    return "instance_unhealthy";
  default:
    return "instance_recovered";
  }
}

void tell(skill_instance_pointer self) {
  const auto& st = self->state;
  const auto& spec = st.row.spec;
  json data{{"task", spec.task}, {"step", spec.step}};
  if (!st.row.health_reason.empty())
    data["reason"] = st.row.health_reason;
  st.config.context.tell(fact_of(st.row.health), spec.instance, data);
}

} // namespace

void on_streams(skill_instance_pointer self,
                const std::vector<stream_figure>& told) {
  auto& st = self->state;
  // What is to end for good, and only waits to be safe, is not started again.
  if (told.empty() || st.row.state != instance_state::running || st.farewell
      || !has_bounds(st.row.spec.life.health))
    return;
  if (!st.health)
    st.health = book_of(st);
  if (!st.health->hear(told, self->clock().now()))
    return;
  st.row.health = st.health->last().health;
  // It quotes an endpoint, which may be a path of any bytes.
  st.row.health_reason = valid_utf8(
      st.health->last().reason.substr(0, limits::instance::reason_bytes));
  tell(self);
  if (st.row.health == instance_health::unhealthy)
    return take_down(self, instance_state::failed,
                     "it is unhealthy: " + st.row.health_reason);
  report(self);
  note(self);
}

void forget_health(skill_instance_state& st) {
  st.health.reset();
  st.row.health = instance_health::good;
  st.row.health_reason.clear();
}

} // namespace roscell
