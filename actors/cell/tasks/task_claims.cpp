#include "actors/cell/tasks/cell_tasks.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "messages/failure.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace roscell {

namespace {

using claim_promise = caf::typed_response_promise<task_claimed>;

caf::error refuse_crowd(const std::string& what) {
  return fail(error_code::conflict, what, "/task",
              "send it again when some are done");
}

/// A request that finds its task going on is one of its run: sent once more
/// after the run has ended it starts no other one. If that cannot be written
/// down it is answered all the same.
/// @param done called once, when all that was to be written of the task before
/// is; may be null.
void join_run(coordinator_pointer self, const claim_task& request,
              const std::function<void()>& done = nullptr) {
  const auto& id = request.request_id;
  const bool is_known =
      id.empty() || self->state.tasks.is_of_run(request.task, id);
  if (is_known && !done)
    return;
  pending_change change;
  change.make = [id = is_known ? std::string{} : id](task_record record) {
    return id.empty() ? record : with_request(std::move(record), id);
  };
  change.done = [done](const completion&) {
    if (done)
      done();
  };
  change_task(self, request.task, std::move(change));
}

/// What of the task has failed is started again, and who asks for it is told.
void heal_and_answer(coordinator_pointer self, const std::string& task,
                     claim_promise promise) {
  if (!self->state.tasks.is_kept(task)) {
    promise.deliver(terminated_meanwhile(task));
    return;
  }
  const auto healed = steps_to_heal(self->state, task);
  if (healed.empty()) {
    promise.deliver(known_reply(self->state, task));
    return;
  }
  heal_task(self, task,
            [self, task, healed, promise](const completion& started) mutable {
              if (!started) {
                promise.deliver(to_error(started.error()));
              } else if (!self->state.tasks.is_kept(task)) {
                promise.deliver(terminated_meanwhile(task));
              } else {
                auto reply = known_reply(self->state, task);
                reply.accepted.healed = healed;
                promise.deliver(std::move(reply));
              }
            });
}

/// The same request again heals what of its task has failed, unless it has been
/// done under its id. An end that has been told and is being written counts,
/// too: who asks has seen it.
void answer_accepted(coordinator_pointer self, const claim_task& request,
                     claim_promise promise) {
  const auto& st = self->state;
  const auto& task = request.task;
  const bool was_done = st.tasks.is_of_run(task, request.request_id);
  const auto heal = [self, task, promise] {
    heal_and_answer(self, task, promise);
  };
  if (!was_done && !st.deployments.untaken_ends(task).empty())
    return join_run(self, request, heal);
  join_run(self, request);
  if (was_done)
    promise.deliver(known_reply(st, task));
  else
    heal();
}

/// Answers a claim whose task is known, or whose name is not free yet. True if
/// that settles it.
bool answer_known(coordinator_pointer self, const claim_task& request,
                  claim_promise promise) {
  auto& st = self->state;
  const auto& task = request.task;
  switch (st.tasks.claim_status_of(task, request.request, request.request_id,
                                   request.replace)) {
  case claim_status::unknown:
  case claim_status::next_run: {
    auto why = why_not_of_set(st, task, request.request);
    if (!why)
      why = remains_of(self, task, request.force);
    if (why)
      promise.deliver(to_error(*why));
    return why.has_value();
  }
  case claim_status::other_body:
    promise.deliver(fail(
        error_code::task_exists, "task '" + task + "' exists with another body",
        "/task", "choose another task id, or terminate this one"));
    break;
  case claim_status::ending:
    promise.deliver(fail(error_code::conflict,
                         "task '" + task + "' is being terminated", "/task",
                         "send it again once it has ended"));
    break;
  case claim_status::accepted:
    answer_accepted(self, request, promise);
    break;
  case claim_status::deploying: {
    join_run(self, request);
    auto& waiting = st.pending.waiters[task].same_requests;
    if (waiting.size() >= limits::task::same_requests)
      promise.deliver(refuse_crowd("too many wait for task '" + task + "'"));
    else
      waiting.push_back(std::move(promise));
  }
  }
  return true;
}

/// The task is the claimant's; it is told what it can be placed on.
void grant_placement_lock(coordinator_pointer self, const claim_task& request,
                          const caf::actor_addr& owner, uint64_t placement_lock,
                          claim_promise promise) {
  auto& st = self->state;
  auto& waiters = st.pending.waiters[request.task];
  if (const auto* entry = st.tasks.find(request.task))
    waiters.former = record_of(request.task, *entry, st.deployments);
  st.tasks.begin(request.task, request.request, request.request_id,
                 unix_now_ms());
  // Whoever asks for it anew knows what is off.
  st.failures.forget_waiting(request.task);
  waiters.owner = owner;
  waiters.placement_lock = placement_lock;
  collect_resources_of_cell(self, [self, task = request.task, placement_lock,
                                   promise](cell_resources&& found) mutable {
    auto& pending = self->state.pending;
    if (self->state.tasks.is_deploying(task)
        && pending.waiters[task].placement_lock == placement_lock)
      promise.deliver(task_claimed{false, {}, std::move(found)});
    else
      promise.deliver(terminated_meanwhile(task));
  });
}

} // namespace

caf::result<task_claimed> claim_placement_lock(coordinator_pointer self,
                                               const claim_task& request) {
  auto& st = self->state;
  // The promise takes the message's sender, so it is looked at before.
  const auto sender = self->current_sender();
  const auto owner = caf::actor_cast<caf::actor_addr>(sender);
  if (sender)
    watch_until_its_end(self, sender);
  auto promise = self->make_response_promise<task_claimed>();
  if (answer_known(self, request, promise))
    return promise;
  if ((st.tasks.is_full() && !st.tasks.find(request.task))
      || st.pending.waiting.size() >= limits::task::waiting) {
    promise.deliver(refuse_crowd("the cell has too many tasks"));
    return promise;
  }
  take_placement_lock(
      self, owner, [self, request, owner, promise](uint64_t placement_lock) {
        if (answer_known(self, request, promise))
          release_placement_lock(self, placement_lock);
        else
          grant_placement_lock(self, request, owner, placement_lock, promise);
      });
  return promise;
}

task_claimed known_reply(const cell_coordinator_state& st,
                         const std::string& task) {
  return {true, status_reply(st, task), {}};
}

} // namespace roscell
