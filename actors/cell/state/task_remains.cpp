#include "actors/cell/state/task_remains.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"

#include <utility>

namespace roscell {

store_record record_of_remains(coordinator_pointer self,
                               const std::string& task) {
  auto& st = self->state;
  auto& remains = st.pending.remains;
  const auto hold = st.failures.hold_of_task(task, self->clock().now());
  if (!hold) {
    remains.erase(task);
    return {"tasks", task, ""};
  }
  remains[task] = hold->until;
  set_timer(self);
  task_record record;
  record.task = task;
  record.state = task_state::terminating;
  return {"tasks", task, json(with_left(self, std::move(record))).dump()};
}

void forget_past_remains(coordinator_pointer self) {
  auto& st = self->state;
  auto& remains = st.pending.remains;
  st.failures.forget_ended(self->clock().now());
  for (auto i = remains.begin(); i != remains.end();) {
    const auto hold = st.failures.hold_of_task(i->first, self->clock().now());
    const bool is_begun_anew = st.tasks.find(i->first) != nullptr;
    if (hold && !is_begun_anew) {
      i->second = hold->until;
      ++i;
      continue;
    }
    if (!is_begun_anew)
      persist_record(self, {"tasks", i->first, ""});
    i = remains.erase(i);
  }
}

} // namespace roscell
