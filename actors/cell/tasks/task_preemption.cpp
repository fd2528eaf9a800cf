#include "actors/cell/tasks/cell_tasks.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// It is gone. Its task knows, and what it was preempted for may have come to
/// nothing meanwhile.
void record_eviction(coordinator_pointer self, const preempt_instances& request,
                     const preempted_instance& x,
                     const completion_handler& done) {
  record_forced_end(self, x.task, x.instance,
                    "it is preempted by task '" + request.task + "'",
                    [self, by = request.task, done](const completion&) {
                      auto& st = self->state;
                      done({});
                      if (st.tasks.is_deploying(by))
                        return;
                      st.orders.let_go_of(by, self->clock().now());
                      wake(self);
                    });
}

void publish_preempted(coordinator_pointer self,
                       const preempt_instances& request,
                       const preempted_instance& x) {
  publish_task_event(self, events::instance_preempted, x.task, x.instance,
                     {{"task", x.task},
                      {"step", x.step},
                      {"node", x.node},
                      {"priority", x.priority},
                      {"by", request.task}});
}

void evict(coordinator_pointer self, const preempt_instances& request,
           const preempted_instance& x, const completion_handler& done) {
  auto& st = self->state;
  const auto* placed = st.deployments.find(x.instance, x.node);
  if (!placed || placed->end)
    return done({});
  ordered_stop stop;
  stop.task = x.task;
  stop.node = x.node;
  stop.order = {x.instance, "it is preempted by task '" + request.task + "'",
                request.task, x.priority};
  stop.force = request.force;
  stop.until = self->clock().now() + limits::task::eviction;
  stop.still = [self, by = request.task] {
    return self->state.tasks.is_deploying(by);
  };
  stop.asked = [self, request, x] { publish_preempted(self, request, x); };
  stop.done = [self, request, x, done](stop_outcome how,
                                       const completion& stopped) {
    if (how == stop_outcome::ended)
      record_eviction(self, request, x, done);
    else
      done(stopped);
  };
  stop_by_order(self, stop);
}

/// It has no place now.
void put_off(coordinator_pointer self, const ordered_end& x,
             const failure& why) {
  auto& st = self->state;
  const auto& instance = x.order.instance;
  // A task that is gone needs no place.
  if (!st.tasks.is_kept(x.task))
    return st.orders.forget(instance);
  if (st.orders.postpone(instance, why.code == error_code::conflict,
                         self->clock().now()))
    return set_timer(self);
  drop_order(self, x.task, instance);
  publish_task_event(self, events::step_stranded, x.task, instance,
                     {{"task", x.task}, {"reason", why.message}});
}

void start_one_again(coordinator_pointer self, const ordered_end& x) {
  const auto& instance = x.order.instance;
  const auto* placed = self->state.deployments.find(instance);
  if (!placed || !placed->end || !self->state.tasks.is_kept(x.task))
    return self->state.orders.forget(instance);
  start_ended(self, x.task, {instance}, [self, x](const completion& started) {
    if (!started)
      put_off(self, x, started.error());
    else
      self->state.orders.forget(x.order.instance);
  });
}

} // namespace

caf::result<instances_preempted>
preempt_for_task(coordinator_pointer self, const preempt_instances& request) {
  if (!self->state.tasks.is_deploying(request.task))
    return terminated_meanwhile(request.task);
  auto promise = self->make_response_promise<instances_preempted>();
  struct tally {
    size_t open = 0;
    std::optional<failure> problem; ///< The last.
  };
  auto all = std::make_shared<tally>();
  all->open = request.preempted.size() + 1;
  auto finish = [all, promise](const completion& evicted) mutable {
    if (!evicted)
      all->problem = evicted.error();
    if (--all->open > 0)
      return;
    if (all->problem)
      promise.deliver(to_error(*all->problem));
    else
      promise.deliver(instances_preempted{});
  };
  for (const auto& x : request.preempted)
    evict(self, request, x, finish);
  finish({});
  return promise;
}

void restore_orders(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& order : entry.orders)
      if (const auto* placed = st.deployments.find(order.instance))
        st.orders.restore(task, order, placed->end.has_value(),
                          self->clock().now());
}

void start_due_again(coordinator_pointer self) {
  for (const auto& x : self->state.orders.take_due(self->clock().now()))
    start_one_again(self, x);
}

} // namespace roscell
