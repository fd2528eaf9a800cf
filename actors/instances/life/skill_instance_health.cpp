#include "actors/core/limits.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/ros2/ros2_program.hpp"
#include "messages/event_kinds.hpp"
#include "schemas/utf8.hpp"

#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// What writes an input, as far as its node has been told.
std::string upstream_step_of(const io_endpoint& input) {
  if (input.external)
    return "a program that no task has started is to write it";
  return input.from.empty() ? "" : "it is fed by step '" + input.from + "'";
}

health_table health_table_of(const skill_instance_state& st) {
  std::vector<std::string> upstream_steps;
  for (const auto& input : st.row.spec.input)
    upstream_steps.push_back(upstream_step_of(input));
  return {st.row.spec, *st.ready_since, std::move(upstream_steps),
          health_verdict{st.row.health, st.row.health_reason}};
}

const event_kind& health_event(instance_health health) {
  switch (health) {
  case instance_health::starved:
    return events::instance_starved;
  case instance_health::unhealthy:
    return events::instance_unhealthy;
  default:
    return events::instance_recovered;
  }
}

void report_change(skill_instance_pointer self) {
  const auto& st = self->state;
  const auto& spec = st.row.spec;
  json data{{"task", spec.task}, {"step", spec.step}};
  if (!st.row.health_reason.empty())
    data["reason"] = st.row.health_reason;
  st.config.context.publish_event(health_event(st.row.health), spec.instance,
                                  data);
}

/// Whether its streams are to be spoken of in another way now.
bool hear_streams(skill_instance_pointer self,
                  const std::vector<stream_metrics>& reported) {
  auto& st = self->state;
  if (reported.empty() || !has_bounds(st.row.spec.life.health))
    return false;
  if (!st.health)
    st.health = health_table_of(st);
  return st.health->hear(reported, self->clock().now());
}

/// Whoever counts frames is of our engine, which names its participant.
void look_for_it(skill_instance_pointer self,
                 const std::vector<stream_count>& frames) {
  auto& st = self->state;
  if (st.sight || !st.config.graph)
    return;
  const auto ends = engine_ends(st.row.spec, frames);
  if (!ends)
    return;
  st.sight.emplace(st.row.health == instance_health::starved
                   && !has_bounds(st.row.spec.life.health));
  self->send(st.config.graph, *ends);
}

/// An output that breaks its bounds counts most; an input that does may do so
/// because nobody knows the instance.
health_verdict verdict_on(const skill_instance_state& st) {
  auto streams = st.health ? st.health->last() : health_verdict{};
  if (streams.health != instance_health::unhealthy && st.sight)
    if (auto why = st.sight->reason(); !why.empty())
      return {instance_health::starved, std::move(why)};
  return streams;
}

void say(skill_instance_pointer self, const health_verdict& x) {
  auto& st = self->state;
  // It quotes an endpoint, which may be a path of any bytes.
  const auto reason =
      valid_utf8(x.reason.substr(0, limits::instance::reason_bytes));
  if (x.health == st.row.health && reason == st.row.health_reason)
    return;
  st.row.health = x.health;
  st.row.health_reason = reason;
  report_change(self);
  if (st.row.health == instance_health::unhealthy)
    return take_down(self, instance_state::failed,
                     "it is unhealthy: " + st.row.health_reason);
  report(self);
  note(self);
}

} // namespace

void follow_health(skill_instance_pointer self, const instance_notified& x) {
  auto& st = self->state;
  // What is to end for good, and only waits to be stop-safe, is not started
  // again.
  if (st.row.state != instance_state::running || st.farewell)
    return;
  const bool heard = hear_streams(self, x.streams);
  look_for_it(self, x.frames);
  const bool sighted = st.sight && st.sight->judge(self->clock().now());
  if (heard || sighted)
    say(self, verdict_on(st));
}

void on_sight(skill_instance_pointer self, const endpoints_missing& x) {
  auto& st = self->state;
  const auto now = self->clock().now();
  st.sight->hear(x.missing, now);
  if (st.row.state == instance_state::running && !st.farewell
      && st.sight->judge(now))
    say(self, verdict_on(st));
}

void forget_health(skill_instance_state& st) {
  st.health.reset();
  st.sight.reset();
  st.row.health = instance_health::good;
  st.row.health_reason.clear();
}

} // namespace roscell
