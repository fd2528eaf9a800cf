#include "actors/cell/transfers/transfer_instances.hpp"

#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/state/transfer_end.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/failure.hpp"

#include <utility>
#include <vector>

namespace roscell {

namespace {

/// Ends the tasks one after the other, then goes on.
void terminate_tasks(coordinator_pointer self, const std::string& id,
                     std::vector<std::string> tasks,
                     const std::function<void()>& next) {
  auto* x = self->state.transfers.find_open(id);
  if (!x)
    return;
  if (tasks.empty())
    return next();
  const auto task = tasks.back();
  tasks.pop_back();
  // From here on nothing brings it back.
  x->terminated.push_back(task);
  self->request(cell_coordinator_actor{self}, limits::task::termination,
                task_termination{task})
      .then(
          [=](const task_terminated& reply) {
            const auto go_on = [=] { terminate_tasks(self, id, tasks, next); };
            // What is not stop-safe yet is still on the node.
            if (reply.waiting.empty() || !self->state.tasks.find(task))
              go_on();
            else
              self->state.pending.waiters[task].gone.push_back(go_on);
          },
          [=](const caf::error& why) {
            call_off_transfer(self, id, to_failure(why));
          });
}

void reschedule_tasks(coordinator_pointer self, const std::string& id,
                      const std::function<void()>& next) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto node = x->row.node;
  const auto tasks = st.deployments.tasks_bound_to(node);
  move_tasks(self, node, tasks, [=](const completion& moved) {
    auto* open = self->state.transfers.find_open(id);
    if (!open)
      return;
    if (!moved)
      return call_off_transfer(self, id, moved.error());
    open->rescheduled = tasks;
    next();
  });
}

} // namespace

void clear_instances(coordinator_pointer self, const std::string& id,
                     instance_policy policy,
                     const std::function<void()>& next) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto node = x->row.node;
  auto tasks = st.deployments.tasks_bound_to(node);
  if (tasks.empty() || policy == instance_policy::refuse)
    return next();
  if (policy == instance_policy::terminate)
    return terminate_tasks(self, id, std::move(tasks), next);
  // What is being deployed cannot be moved before it runs.
  after_deployments_on(self, node, [=] { reschedule_tasks(self, id, next); });
}

} // namespace roscell
