#include "actors/cell/state/task_story.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/core/wall_clock.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

/// A reason may quote a log.
std::string bounded_text(json data) {
  for (auto& [name, value] : data.items())
    if (value.is_string()
        && value.get_ref<const std::string&>().size()
               > limits::task::event_text_bytes)
      value =
          value.get<std::string>().substr(0, limits::task::event_text_bytes);
  return data.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Tells it, and takes it up into the history.
void add_event(coordinator_pointer self, const event_kind& what,
               const std::string& task, const std::string& subject,
               const json& data) {
  auto& st = self->state;
  st.context.publish_event(what, subject, data);
  auto added = st.history.add(task, {0, unix_now_ms(), std::string{what.name},
                                     subject, bounded_text(data)});
  const auto& recorded = added.record.recorded;
  st.events.push_back({"history", history_key(task, recorded.sequence),
                       json(added.record).dump(), true});
  for (auto& key : added.dropped)
    st.events.push_back({"history", std::move(key), "", true});
}

void write_events(coordinator_pointer self) {
  auto& st = self->state;
  st.events_due = std::chrono::steady_clock::time_point::max();
  keep_records(
      self, std::exchange(st.events, {}), [] {}, [](const failure&) {});
}

} // namespace

void publish_task_event(coordinator_pointer self, const event_kind& what,
                        const std::string& task, const std::string& subject,
                        const json& data) {
  add_event(self, what, task, subject, data);
  write_events(self);
}

void publish_repeated_event(coordinator_pointer self, const event_kind& what,
                            const std::string& task, const std::string& subject,
                            const json& data) {
  constexpr std::chrono::seconds span{2};
  constexpr size_t most = 128;
  add_event(self, what, task, subject, data);
  auto& st = self->state;
  if (st.events.size() >= most)
    return write_events(self);
  st.events_due = std::min(st.events_due, self->clock().now() + span);
  set_timer(self);
}

void write_due_events(coordinator_pointer self) {
  if (self->clock().now() >= self->state.events_due)
    write_events(self);
}

caf::result<task_history> report_history(const cell_coordinator_state& st,
                                         const task_history_query& query) {
  if (auto known = st.history.find(query.task))
    return std::move(*known);
  return fail(error_code::unknown_task,
              "nothing is known of a task '" + query.task + "'", "/task",
              "`roscell tasks` lists those that are there");
}

} // namespace roscell
