#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <utility>

namespace roscell {

namespace {

struct set_ending {
  task_terminated reply;
  size_t open = 0;
  caf::typed_response_promise<task_terminated> promise;
};

void on_one_ended(coordinator_pointer self,
                  const std::shared_ptr<set_ending>& ending) {
  if (--ending->open > 0)
    return;
  self->state.context.publish_event(events::set_removed, ending->reply.task);
  ending->promise.deliver(std::move(ending->reply));
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void end_task_of(coordinator_pointer self, const std::string& task, bool force,
                 const std::shared_ptr<set_ending>& ending) {
  ++ending->open;
  self->request(cell_coordinator_actor{self}, limits::task::termination,
                task_termination{task, force})
      .then(
          [self, ending](const task_terminated& x) {
            append(ending->reply.instances, x.instances);
            append(ending->reply.pending_nodes, x.pending_nodes);
            append(ending->reply.waiting, x.waiting);
            on_one_ended(self, ending);
          },
          // It goes on, as any termination does.
          [self, ending](const caf::error&) { on_one_ended(self, ending); });
}

void end_tasks_of(coordinator_pointer self, const task_termination& request,
                  caf::typed_response_promise<task_terminated> promise) {
  auto& st = self->state;
  st.sets.forget(request.task);
  auto ending = std::make_shared<set_ending>();
  ending->reply.task = request.task;
  ending->promise = std::move(promise);
  ending->open = 1;
  std::vector<std::string> tasks;
  for (const auto& [task, entry] : st.tasks.entries())
    if (entry.set == request.task)
      tasks.push_back(task);
  for (const auto& task : tasks)
    end_task_of(self, task, request.force, ending);
  on_one_ended(self, ending);
}

} // namespace

caf::result<task_terminated> remove_set(coordinator_pointer self,
                                        const task_termination& request) {
  auto promise = self->make_response_promise<task_terminated>();
  keep_records(
      self, {{set_records, request.task, ""}},
      [self, request, promise] { end_tasks_of(self, request, promise); },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
  return promise;
}

} // namespace roscell
