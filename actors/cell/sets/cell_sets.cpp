#include "actors/cell/sets/cell_sets.hpp"

#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

namespace roscell {

namespace {

/// A node that is thought of, to see whether a set can be read.
constexpr const char* some_node = "node";

using plan_promise = caf::typed_response_promise<task_set_plan>;

store_record stored(const task_set_record& record) {
  return {set_records, record.task, json(record).dump()};
}

/// Whether it can be read at all, as the task of one of its nodes; where there
/// is none, what does not depend on skills.
std::optional<failure> why_unreadable(const cell_coordinator_state& st,
                                      const task_set_request& request,
                                      const std::vector<set_step>& steps) {
  const auto wanted =
      std::find_if(steps.begin(), steps.end(), [](const auto& x) {
        return x.is_wanted && x.task->problem.empty();
      });
  if (wanted == steps.end()) {
    const auto thought = task_for(request, some_node);
    if (const auto* why = std::get_if<failure>(&thought))
      return *why;
    return std::nullopt;
  }
  const auto read =
      read_task(wanted->change.task, wanted->task->request.pipeline,
                {skills_within_reach(st), written_in(st), std::nullopt});
  if (const auto* why = std::get_if<failure>(&read))
    return *why;
  return std::nullopt;
}

std::optional<failure> why_refused(const cell_coordinator_state& st,
                                   const task_set_request& request) {
  const auto* known = st.sets.find(request.task);
  if (st.tasks.find(request.task))
    return failure{error_code::conflict,
                   "there is a task '" + request.task + "'", "/task",
                   "stop it, or give the set another name"};
  if (!known && st.sets.is_full())
    return failure{error_code::conflict, "the cell has too many sets of tasks",
                   "/task", "stop one of them"};
  if (known && request.only_new && known->record.request != body_of(request))
    return failure{error_code::task_exists,
                   "a set of tasks '" + request.task
                       + "' exists with another body",
                   "/task", "`roscell apply` changes it"};
  return std::nullopt;
}

task_set_record record_for(const cell_coordinator_state& st,
                           const task_set_request& request) {
  task_set_record result{request.task, body_of(request), unix_now_ms()};
  if (const auto* known = st.sets.find(request.task)) {
    result.revision = known->record.revision + 1;
    result.run = known->record.run + (request.run_again ? 1 : 0);
  }
  return result;
}

/// What the steps come to, for whoever has asked.
task_set_plan plan_for(const task_set_request& request,
                       const std::vector<set_step>& steps,
                       update_outcome outcome, bool is_new) {
  task_set_plan result;
  result.task = request.task;
  result.outcome = outcome;
  result.is_new = is_new;
  for (const auto& x : steps) {
    result.changes.push_back(x.change);
    if (!x.problem.empty())
      result.changes.back().reason = x.problem;
  }
  return result;
}

/// Whether anything is to be done that is not being done already.
bool differs(const cell_coordinator_state& st, const task_set_request& request,
             const std::vector<set_step>& steps) {
  const auto* known = st.sets.find(request.task);
  return !known || known->record.request != body_of(request)
         || !known->record.stopped.empty() || request.run_again
         || std::any_of(steps.begin(), steps.end(), [](const auto& x) {
              return x.change.action != set_action::stays;
            });
}

void begin_set(coordinator_pointer self, const task_set_record& record,
               const task_set_plan& plan) {
  auto& st = self->state;
  st.sets.apply(record);
  const auto changes = std::count_if(
      plan.changes.begin(), plan.changes.end(),
      [](const auto& x) { return x.action != set_action::stays; });
  st.context.publish_event(events::set_applied, record.task,
                           {{"revision", record.revision},
                            {"nodes", plan.changes.size()},
                            {"changes", changes}});
  look_at_sets(self);
}

/// The same set once more, in the order in which requests come: the last one
/// that was asked for stays.
void write_set(coordinator_pointer self, const task_set_record& record,
               const task_set_plan& plan, plan_promise promise) {
  keep_records(
      self, {stored(record)},
      [self, record, plan, promise]() mutable {
        begin_set(self, record, plan);
        promise.deliver(plan);
      },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
}

} // namespace

void restore_sets(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& record : st.setup.sets)
    if (!st.sets.apply(record))
      persist_record(self, {set_records, record.task, ""});
}

caf::result<task_set_plan> apply_set(coordinator_pointer self,
                                     const task_set_request& request) {
  auto& st = self->state;
  if (auto why = why_refused(st, request))
    return to_error(*why);
  const auto record = record_for(st, request);
  const auto steps =
      plan_of_set(st, {record, request, std::make_shared<node_tasks>()});
  if (auto why = why_unreadable(st, request, steps))
    return to_error(*why);
  const bool is_new = st.sets.find(request.task) == nullptr;
  if (!differs(st, request, steps))
    return plan_for(request, steps, update_outcome::unchanged, is_new);
  if (request.dry_run)
    return plan_for(request, steps, update_outcome::shown, is_new);
  auto promise = self->make_response_promise<task_set_plan>();
  write_set(self, record,
            plan_for(request, steps, update_outcome::begun, is_new), promise);
  return promise;
}

void note_stopped_by_user(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  const auto* entry = st.tasks.find(task);
  const auto set = entry ? entry->set : std::string{};
  const auto* known = st.sets.find(set);
  if (!known)
    return;
  const auto node = task.substr(task_name(set, "").size());
  auto record = known->record;
  if (std::count(record.stopped.begin(), record.stopped.end(), node) > 0)
    return;
  record.stopped.push_back(node);
  st.sets.apply(record);
  persist_record(self, stored(record));
  look_at_sets(self);
}

std::optional<failure> why_kept_by_set(const cell_coordinator_state& st,
                                       const std::string& task,
                                       const std::string& body) {
  const auto* entry = st.tasks.find(task);
  const auto* known = entry ? st.sets.find(entry->set) : nullptr;
  if (!known)
    return std::nullopt;
  const auto node = task.substr(task_name(entry->set, "").size());
  if (known->tasks->of(known->request, node)->body == body)
    return std::nullopt;
  return failure{error_code::conflict,
                 "task '" + task + "' is one of the set '" + entry->set
                     + "', which would put it back",
                 "/task", "change the set's file and `roscell apply` it"};
}

std::optional<failure> why_not_of_set(const cell_coordinator_state& st,
                                      const std::string& task,
                                      const std::string& request) {
  if (st.sets.find(task))
    return failure{error_code::conflict,
                   "there is a set of tasks '" + task + "'", "/task",
                   "give the task another name, or stop the set"};
  const auto set = set_of(request);
  if (!set.empty() && !st.sets.find(set))
    return failure{error_code::conflict,
                   "there is no set of tasks '" + set + "'", "/set",
                   "leave it out: a set makes its tasks itself"};
  return std::nullopt;
}

} // namespace roscell
