#include "actors/cell/state/task_story.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

/// A reason may quote a log.
std::string bounded_text(json data) {
  for (auto& [name, value] : data.items())
    if (value.is_string()
        && value.get_ref<const std::string&>().size()
               > limits::task::fact_text_bytes)
      value = value.get<std::string>().substr(0, limits::task::fact_text_bytes);
  return data.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace

void tell_of_task(coordinator_pointer self, const char* what,
                  const std::string& task, const std::string& subject,
                  const json& data) {
  auto& st = self->state;
  st.context.tell(what, subject, data);
  auto added = st.history.add(
      task, {0, unix_now_ms(), what, subject, bounded_text(data)});
  const auto& fact = added.record.fact;
  record_fact(self, {"history", history_key(task, fact.sequence),
                     json(added.record).dump()});
  for (auto& key : added.dropped)
    record_fact(self, {"history", std::move(key), ""});
}

caf::result<task_history> tell_history(const cell_coordinator_state& st,
                                       const task_history_query& query) {
  if (auto known = st.history.find(query.task))
    return std::move(*known);
  return fail(error_code::unknown_task,
              "nothing is known of a task '" + query.task + "'", "/task",
              "`roscell tasks` lists those that are there");
}

} // namespace roscell
