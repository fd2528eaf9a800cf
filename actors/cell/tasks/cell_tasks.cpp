#include "actors/cell/tasks/cell_tasks.hpp"

#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

caf::error node_left(const std::string& node) {
  return fail(error_code::conflict,
              "node '" + node + "' left while the task was being placed",
              "/pipeline", "send the request again");
}

/// The agents of nodes that are active, or the first one that is not.
std::variant<std::vector<node_agent_actor>, std::string>
find_agents(const cell_coordinator_state& st,
            const std::vector<std::string>& nodes) {
  std::vector<node_agent_actor> result;
  for (const auto& node : nodes) {
    const auto* member = st.registry.find_name(node);
    if (!member || member->row.state != row_state::active)
      return node;
    result.push_back(member->agent);
  }
  return result;
}

/// A task that cannot be written down is not started, or does not stay.
caf::error not_written_down(const std::string& task, const failure& why) {
  return fail(why.code,
              "task '" + task + "' cannot be written down: " + why.message,
              "/task",
              "make room on the disk of the coordination node and send the "
              "request again; nothing of it runs");
}

/// Answers an intent or the word that all runs, when the store did not keep it.
template <class Reply>
void refuse_unwritten(coordinator_pointer self, const std::string& task,
                      const failure& why, const std::vector<std::string>& nodes,
                      caf::typed_response_promise<Reply> promise) {
  if (!self->state.tasks.is_deploying(task)) {
    promise.deliver(terminated_meanwhile(task));
    return;
  }
  roll_back(self, task, "it cannot be written down: " + why.message, nodes,
            [promise, task, why]() mutable {
              promise.deliver(not_written_down(task, why));
            });
}

/// What the run before has left on its nodes is not wanted any more. A node
/// that is away is told so when it registers.
void remove_former(coordinator_pointer self,
                   const std::optional<task_record>& former) {
  if (!former)
    return;
  for (const auto& x : deployments_in(*former))
    remove_instance(self, {x.node, former->task, x.spec.instance}, [] {});
}

void on_accepted(coordinator_pointer self, const std::string& task,
                 caf::typed_response_promise<task_accepted> promise) {
  auto& st = self->state;
  if (!st.tasks.is_kept(task)) {
    promise.deliver(terminated_meanwhile(task));
    return;
  }
  auto& waiters = st.pending.waiters[task];
  waiters.owner = nullptr;
  auto reply = reply_of(task, *st.tasks.find(task), st.deployments);
  reply.found = waiters.former ? task_found::anew : task_found::started;
  remove_former(self, std::exchange(waiters.former, std::nullopt));
  promise.deliver(std::move(reply));
  for (auto& other : std::exchange(waiters.same_requests, {}))
    other.deliver(known_reply(st, task));
  json data{{"instances", st.deployments.of_task(task).size()}};
  if (const auto run = st.tasks.find(task)->run; run > 1)
    data["run"] = run;
  publish_task_event(self, events::task_accepted, task, task, data);
  record_ends(self, task);
  settle_ended(self, task);
  settle_awaited_deployments(self);
  st.orders.let_go_of(task, self->clock().now());
  wake(self);
}

} // namespace

void restore_tasks(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& stored : st.setup.tasks) {
    const auto record = restored(stored);
    if (!record)
      continue;
    st.tasks.apply(*record);
    st.deployments.place(record->task, deployments_in(*record));
    follow_deadline(self, record->task);
  }
}

void drop_unfinished_tasks(coordinator_pointer self) {
  for (const auto& stored : self->state.setup.tasks)
    if (!restored(stored))
      persist_record(self, record_of_remains(self, stored.task));
}

caf::result<intent_recorded> hold_placement(coordinator_pointer self,
                                            const record_intent& intent) {
  auto& st = self->state;
  const auto& task = intent.task;
  if (!st.tasks.is_deploying(task))
    return terminated_meanwhile(task);
  auto found = find_agents(st, intent.nodes);
  if (const auto* gone = std::get_if<std::string>(&found))
    return node_left(*gone);
  intent_recorded reply{
      intent.specs, std::get<std::vector<node_agent_actor>>(std::move(found))};
  for (auto& spec : reply.specs)
    complete_spec(st, spec);
  // What spoke against it is asked once more: to place it took its time.
  if (!st.failures.has_room(reply.specs.size()))
    return fail(error_code::conflict, "the cell runs too many instances",
                "/pipeline", "send it again when some have ended");
  for (const auto& spec : reply.specs)
    if (auto why = why_not_yet(self, {task, spec.step}))
      return to_error(*why);
  auto promise = self->make_response_promise<intent_recorded>();
  pending_change change;
  change.still = &task_table::is_deploying;
  change.make = [intent, specs = reply.specs](task_record record) {
    return with_placement(std::move(record), intent.decision, specs,
                          intent.nodes);
  };
  change.done = [self, intent, reply, promise](const completion& kept) mutable {
    if (!kept)
      return refuse_unwritten(self, intent.task, kept.error(), intent.nodes,
                              promise);
    // From here on the pipeline may start them at any time.
    for (size_t i = 0; i < reply.specs.size(); ++i)
      note_start(self, reply.specs[i], intent.nodes[i]);
    reply.offers = offers_for(self->state, reply.specs, intent.nodes);
    release_placement_lock(
        self, self->state.pending.waiters[intent.task].placement_lock);
    promise.deliver(std::move(reply));
  };
  change_task(self, task, std::move(change));
  return promise;
}

caf::result<task_accepted> accept_task(coordinator_pointer self,
                                       const record_running& event) {
  auto promise = self->make_response_promise<task_accepted>();
  pending_change change;
  change.still = &task_table::is_deploying;
  change.make = [self, task = event.task](task_record record) {
    const auto now = unix_now_ms();
    return with_deadline(
        with_ends(with_state(std::move(record), task_state::running),
                  self->state.deployments.untaken_ends(task), now),
        now);
  };
  change.done = [self, task = event.task, promise](const completion& kept) {
    if (!kept)
      refuse_unwritten(self, task, kept.error(), {}, promise);
    else
      on_accepted(self, task, promise);
  };
  change_task(self, event.task, std::move(change));
  return promise;
}

caf::result<task_rolled_back> undo_deployment(coordinator_pointer self,
                                              const record_failure& event) {
  // A task that was terminated meanwhile has been settled already.
  if (!self->state.tasks.is_deploying(event.task))
    return task_rolled_back{};
  auto promise = self->make_response_promise<task_rolled_back>();
  roll_back(self, event.task, event.reason, {},
            [promise]() mutable { promise.deliver(task_rolled_back{}); });
  return promise;
}

void on_pipeline_down(coordinator_pointer self, const caf::actor_addr& gone) {
  leave_line(self, gone);
  for (const auto& [task, waiters] : self->state.pending.waiters)
    if (waiters.owner && waiters.owner == gone)
      return on_owner_gone(self, std::string{task});
}

} // namespace roscell
