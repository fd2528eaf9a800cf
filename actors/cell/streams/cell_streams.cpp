#include "actors/cell/streams/cell_streams.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/core/limits.hpp"
#include "messages/event_kinds.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <string>

namespace roscell {

namespace {

/// A topic's name may be cut in the middle of a letter.
std::string bounded(const std::string& reason) {
  return valid_utf8(reason.substr(0, limits::instance::reason_bytes));
}

void publish_verdict(coordinator_pointer self, const std::string& instance) {
  const auto& st = self->state;
  const auto row = st.deployments.find_row(instance);
  if (!row)
    return;
  const auto* reason = st.streams.reason_of(instance);
  json data{{"task", row->spec.task}, {"step", row->spec.step}};
  if (reason)
    data["reason"] = bounded(*reason);
  st.context.publish_event(reason ? events::instance_starved
                                  : events::instance_recovered,
                           instance, data);
  publish_change(self, *row, row->node);
}

} // namespace

void judge_streams(coordinator_pointer self,
                   const std::set<std::string>& reported) {
  auto& st = self->state;
  for (const auto& instance :
       st.streams.judge(st.deployments.all_reported(), reported))
    publish_verdict(self, instance);
}

bool is_doubtful(const cell_coordinator_state& st, const instance_row& row) {
  const auto& streams = row.metrics.streams;
  return row.state == instance_state::running
         && (st.streams.reason_of(row.spec.instance) != nullptr
             || std::any_of(streams.begin(), streams.end(), [](const auto& x) {
                  return x.end.rfind("input:", 0) == 0
                         && x.quiet_s >= stream_watch::long_enough_s;
                }));
}

instance_health health_of(const cell_coordinator_state& st,
                          const std::string& instance, instance_state state,
                          instance_health reported) {
  return reported == instance_health::good && state == instance_state::running
                 && st.streams.reason_of(instance) != nullptr
             ? instance_health::starved
             : reported;
}

void add_verdict(const cell_coordinator_state& st, instance_row& row) {
  const auto health = health_of(st, row.spec.instance, row.state, row.health);
  if (health == row.health)
    return;
  row.health = health;
  row.health_reason = bounded(*st.streams.reason_of(row.spec.instance));
}

void publish_change(coordinator_pointer self, instance_row x,
                    const std::string& node) {
  add_verdict(self->state, x);
  json data{{"task", x.spec.task},
            {"step", x.spec.step},
            {"node", node},
            {"state", to_word(x.state)}};
  if (!x.reason.empty())
    data["reason"] = x.reason;
  if (x.exit_code >= 0)
    data["exit_code"] = x.exit_code;
  if (x.restarts > 0)
    data["restarts"] = x.restarts;
  if (x.next_start_unix_ms > 0)
    data["next_start_unix_ms"] = x.next_start_unix_ms;
  if (x.health != instance_health::good)
    data["health"] = to_word(x.health);
  if (!x.health_reason.empty())
    data["health_reason"] = x.health_reason;
  if (!x.waits.empty())
    data["waits"] = x.waits;
  const auto& what = events::instance_changed;
  const auto& task = x.spec.task;
  // Of a new start its history has the end before, and that it runs.
  if (x.restarts > 0 && x.state < instance_state::running)
    self->state.context.publish_event(what, x.spec.instance, data);
  else if (x.restarts > 0 && x.state <= instance_state::backing_off)
    publish_repeated_event(self, what, task, x.spec.instance, data);
  else
    publish_task_event(self, what, task, x.spec.instance, data);
}

} // namespace roscell
