#include "actors/cell/tasks/task_endings.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/updates/update_guard.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// Whether a task that is not running yet, or is being rolled back, has
/// something on the node.
bool is_deploying_on(const cell_coordinator_state& st,
                     const std::string& node) {
  const auto tasks = st.deployments.tasks_bound_to(node);
  return std::any_of(tasks.begin(), tasks.end(), [&](const auto& task) {
    const auto* entry = st.tasks.find(task);
    return entry && entry->state == task_state::deploying;
  });
}

/// The one way in which what waits for a task comes to its end: it is gone from
/// the tables, or is as it was before it was begun.
/// @param why What the same request hears.
void end_waiting(coordinator_pointer self, const task_terminated& reply,
                 const caf::error& why) {
  auto& st = self->state;
  auto& waiters = st.pending.waiters;
  const auto gone = std::move(waiters[reply.task]);
  waiters.erase(reply.task);
  st.orders.let_go_of(reply.task, self->clock().now());
  wake(self);
  for (auto promise : gone.terminations)
    promise.deliver(reply);
  for (auto promise : gone.same_requests)
    promise.deliver(why);
  for (const auto& next : gone.gone)
    next();
  release_placement_lock(self, gone.placement_lock);
  settle_awaited_deployments(self);
}

void publish_terminated(coordinator_pointer self,
                        const task_terminated& reply) {
  self->state.tasks.remember_terminated(reply);
  publish_task_event(
      self, events::task_terminated, reply.task, reply.task,
      {{"instances", reply.instances}, {"pending_nodes", reply.pending_nodes}});
  end_waiting(self, reply, terminated_meanwhile(reply.task));
}

/// Whoever waits for a termination hears that it is not on disk, and may ask
/// again. The instances are gone.
void refuse_waiting_terminations(coordinator_pointer self,
                                 const std::string& task, const failure& why) {
  auto& waiting = self->state.pending.waiters[task].terminations;
  for (auto& promise : std::exchange(waiting, {}))
    promise.deliver(fail(
        why.code,
        "the instances of task '" + task
            + "' are gone, but that cannot be written down: " + why.message,
        "/task",
        "make room on the disk of the coordination node; it is tried "
        "again until then, and a restart before would start the task"));
}

/// Answers when the store has removed the record.
void remove_record(coordinator_pointer self, const task_terminated& reply) {
  pending_change change;
  change.insistent = true;
  change.done = [self, reply](const completion&) {
    publish_terminated(self, reply);
  };
  change.on_problem = [self, task = reply.task,
                       since = self->clock().now()](const failure& why) {
    if (self->clock().now() - since >= limits::task::unwritten)
      refuse_waiting_terminations(self, task, why);
  };
  change_task(self, reply.task, std::move(change));
}

/// Whoever waits for a termination hears what is not stop-safe yet.
void answer_terminations(coordinator_pointer self,
                         const task_terminated& reply) {
  auto& waiting = self->state.pending.waiters[reply.task].terminations;
  for (auto& promise : std::exchange(waiting, {}))
    promise.deliver(reply);
}

/// Removes the instances of a task that no pipeline works on any more.
void finish_termination(coordinator_pointer self, const std::string& task,
                        bool force) {
  const auto& st = self->state;
  task_terminated reply{task, {}, {}};
  for (const auto& x : st.deployments.of_task(task))
    reply.instances.push_back(x.spec.instance);
  task_removal removal{task, {}, force};
  // How long that takes nobody knows, so nobody has to wait for it.
  removal.waits = [self, reply](const auto& waiting) {
    auto early = reply;
    early.waiting = waiting;
    answer_terminations(self, early);
  };
  removal.done = [self, reply](const auto& away) mutable {
    reply.pending_nodes = away;
    remove_record(self, reply);
  };
  remove_everywhere(self, removal);
}

caf::error first_failed(const std::string& reason) {
  return fail(error_code::engine_failed,
              "the first request for this task failed: " + reason, "/task",
              "send it again");
}

/// A task of which nothing was placed anywhere has not failed: its request was
/// refused, and that is told already.
void publish_rolled_back(coordinator_pointer self, const std::string& task,
                         const std::string& reason, bool begun) {
  if (begun)
    publish_task_event(self, events::task_failed, task, task,
                       {{"reason", reason}});
  end_waiting(self, {task, {}, {}}, first_failed(reason));
}

/// A task that is rolled back is not gone yet. Whoever waits for the request
/// hears what has become of it.
void acknowledge_termination(coordinator_pointer self, const std::string& task,
                             const std::string& reason,
                             const std::vector<safety_wait>& waiting) {
  auto& same = self->state.pending.waiters[task].same_requests;
  for (auto& promise : std::exchange(same, {}))
    promise.deliver(first_failed(reason));
  answer_terminations(self, {task, {}, {}, waiting});
}

/// Writes down that a task is being ended. Without it a restart would take the
/// task up again, which the removal of the record says better and later.
void record_ending(coordinator_pointer self, const std::string& task) {
  pending_change change;
  change.make = [](task_record record) {
    return with_state(std::move(record), task_state::terminating);
  };
  change_task(self, task, std::move(change));
}

/// It is being ended already. Asked again, it is ended by force; nobody waits
/// for what is not stop-safe, the second time either.
void end_anyway(coordinator_pointer self, const task_termination& request) {
  auto& st = self->state;
  const auto& task = request.task;
  retry_change(self, task);
  if (request.force)
    return force_removals(self, task);
  task_terminated reply{task, {}, {}, safety_waits_of(st, task)};
  if (!reply.waiting.empty())
    answer_terminations(self, reply);
}

} // namespace

void end_settled(coordinator_pointer self, const std::string& task) {
  if (!self->state.tasks.begin_ending(task))
    return;
  record_ending(self, task);
  finish_termination(self, task, false);
}

caf::error terminated_meanwhile(const std::string& task) {
  return fail(error_code::conflict,
              "task '" + task + "' was terminated meanwhile", "/task");
}

namespace {

/// Sets, releases and transfers end tasks, too: they ask as this actor.
bool is_asked_from_outside(coordinator_pointer self) {
  return caf::actor_cast<caf::actor_addr>(self->current_sender())
         != self->address();
}

} // namespace

caf::result<task_terminated> terminate_task(coordinator_pointer self,
                                            const task_termination& request) {
  auto& st = self->state;
  const auto& task = request.task;
  if (st.sets.find(task))
    return remove_set(self, request);
  if (is_asked_from_outside(self))
    note_stopped_by_user(self, task);
  if (!st.tasks.find(task)) {
    if (const auto* ended = st.tasks.find_terminated(task))
      return *ended;
    return fail(error_code::unknown_task, "no task '" + task + "' is known",
                "/task", "`roscell tasks` lists them");
  }
  auto promise = self->make_response_promise<task_terminated>();
  auto& waiters = st.pending.waiters[task];
  waiters.terminations.push_back(promise);
  if (!st.tasks.begin_ending(task)) {
    end_anyway(self, request);
    return promise;
  }
  drop_update(self, task);
  const auto owner = waiters.owner;
  release_placement_lock(self, waiters.placement_lock);
  record_ending(self, task);
  // Nothing that the pipeline sends may reach a node after the removal, so the
  // pipeline ends first.
  waiters.force = request.force;
  if (owner)
    self->send_exit(owner, terminated_meanwhile(task));
  else
    finish_termination(self, task, request.force);
  return promise;
}

namespace {

/// The task is as it was before its deployment began: there was none, or its
/// run before had ended. Where that cannot be written down its record goes when
/// there is room; the next start drops what was being deployed, too.
void take_back(coordinator_pointer self, const std::string& task,
               const std::optional<task_record>& former, bool is_unwritten) {
  auto& st = self->state;
  if (is_unwritten && !former)
    persist_record(self, record_of_remains(self, task));
  st.tasks.forget(task);
  st.deployments.forget_task(task);
  look_at_sets(self);
  if (!former)
    return;
  st.tasks.take_back(*former);
  st.deployments.place(task, deployments_in(*former));
}

} // namespace

void roll_back(coordinator_pointer self, const std::string& task,
               const std::string& reason,
               const std::vector<std::string>& also_on,
               const std::function<void()>& done) {
  auto& st = self->state;
  st.tasks.begin_ending(task);
  st.pending.waiters[task].owner = nullptr;
  // Before it was placed there was nothing to be begun.
  const bool begun = !st.tasks.find(task)->accepted.empty();
  // Called once, whichever comes first.
  const auto open = std::make_shared<std::function<void()>>(done);
  const auto finish = [open] {
    if (const auto next = std::exchange(*open, nullptr))
      next();
  };
  task_removal removal{task, also_on};
  removal.waits = [self, task, reason, finish](const auto& waiting) {
    acknowledge_termination(self, task, reason, waiting);
    finish();
  };
  removal.done = [self, task, reason, begun, finish](const auto&) {
    pending_change change;
    const auto former =
        std::exchange(self->state.pending.waiters[task].former, std::nullopt);
    if (former)
      change.make = [former](const task_record&) { return *former; };
    change.done = [self, task, reason, begun, former,
                   finish](const completion& kept) {
      take_back(self, task, former, !kept);
      publish_rolled_back(self, task, reason, begun);
      finish();
    };
    change_task(self, task, std::move(change));
  };
  remove_everywhere(self, removal);
}

void on_owner_gone(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  st.pending.waiters[task].owner = nullptr;
  if (st.tasks.is_deploying(task))
    roll_back(self, task, "the request that deployed it has ended", {}, [] {});
  else
    finish_termination(self, task, st.pending.waiters[task].force);
}

void after_deployments_on(coordinator_pointer self, const std::string& node,
                          std::function<void()> done) {
  self->state.pending.deployments_awaited.push_back({node, std::move(done)});
  settle_awaited_deployments(self);
}

void settle_awaited_deployments(coordinator_pointer self) {
  auto& st = self->state;
  auto waiting = std::exchange(st.pending.deployments_awaited, {});
  for (auto& x : waiting)
    if (is_deploying_on(st, x.node))
      st.pending.deployments_awaited.push_back(std::move(x));
    else
      x.done();
}

} // namespace roscell
