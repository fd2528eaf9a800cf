#include "actors/requests/handlers/task_pipeline.hpp"

#include "actors/core/alarm.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/watching.hpp"
#include "actors/requests/limits.hpp"
#include "messages/event.hpp"

#include <caf/send.hpp>

#include <functional>
#include <memory>
#include <utility>

namespace roscell {

namespace {

/// More than any event has: only new ones are wanted.
constexpr uint64_t from_now_on = 9007199254740991;

/// Waits for one query, and ends with its answer.
struct task_change_waiter_state {
  static constexpr const char* name = "task-change-waiter";

  cell_coordinator_actor coordinator;
  task_change_query query;
  caf::typed_response_promise<task_change> promise;
  std::shared_ptr<const void> place; ///< One of those that may wait.
  bool asking = false;
  bool again = false; ///< Something has happened since it was asked.
  bool over = false;  ///< The asker waits no longer.
  alarm timer;
};

using waiter_pointer =
    task_change_waiter_actor::stateful_pointer<task_change_waiter_state>;

void ask_for_task(waiter_pointer self);

void on_task(waiter_pointer self, task_description known) {
  auto& st = self->state;
  st.asking = false;
  auto mark = mark_of(known);
  if (mark != st.query.known || st.over) {
    st.promise.deliver(task_change{std::move(mark), std::move(known.tasks),
                                   std::move(known.sets)});
    return self->quit();
  }
  if (std::exchange(st.again, false))
    ask_for_task(self);
}

void on_refusal(waiter_pointer self, caf::error& why) {
  // That the cell has no such task is an answer, too.
  if (to_failure(why).code == error_code::unknown_task)
    return on_task(self, {});
  self->state.promise.deliver(std::move(why));
  self->quit();
}

/// While it is asked, whatever happens is asked for once more.
void ask_for_task(waiter_pointer self) {
  auto& st = self->state;
  st.again = st.asking;
  if (std::exchange(st.asking, true))
    return;
  self->request(st.coordinator, limits::local::answer,
                task_query{st.query.task})
      .then([self](task_description& x) { on_task(self, std::move(x)); },
            [self](caf::error& why) { on_refusal(self, why); });
}

/// A node that is lost or back changes the tasks that it has steps of.
bool may_change(const event& e, const std::string& task) {
  if (e.subject == task || e.what.compare(0, 5, "node_") == 0)
    return true;
  // Most events are about others, and many may wait.
  if (e.data.find(task) == std::string::npos)
    return false;
  const auto data = json::parse(e.data, nullptr, false);
  return data.is_object() && data.value("task", json{}) == task;
}

caf::result<task_change> begin_waiting(waiter_pointer self,
                                       task_change_query& query,
                                       const event_log_actor& events) {
  auto& st = self->state;
  st.query = std::move(query);
  st.promise = self->make_response_promise<task_change>();
  self->send(events, subscribe_events{event_listener_actor{self}, from_now_on});
  self->state.timer.set(
      self, self->clock().now() + std::chrono::milliseconds{st.query.wait_ms});
  // After the subscription, so that no change falls between the two.
  ask_for_task(self);
  return st.promise;
}

void on_alarm(waiter_pointer self) {
  self->state.over = true;
  ask_for_task(self);
}

/// The coordinator has ended. Nobody else would answer: to end is no answer.
void give_up(waiter_pointer self) {
  auto& promise = self->state.promise;
  if (promise.pending())
    promise.deliver(caf::make_error(caf::sec::request_receiver_down));
  self->quit();
}

task_change_waiter_actor::behavior_type
task_change_waiter(waiter_pointer self, const event_log_actor& events,
                   const cell_coordinator_actor& coordinator,
                   const std::shared_ptr<const void>& place) {
  self->state.coordinator = coordinator;
  self->state.place = place;
  watch_until_own_end(self, coordinator);
  self->set_down_handler([self](const caf::down_msg&) { give_up(self); });
  return {
      [self](const state_query&) {
        return state_of({{"task", self->state.query.task}});
      },
      [self](const event& e) {
        if (may_change(e, self->state.query.task))
          ask_for_task(self);
      },
      [self, events](task_change_query& query) {
        return begin_waiting(self, query, events);
      },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

/// Given back with the last copy of what is returned; null: none is left.
std::shared_ptr<const void> take_place(const request_context& context) {
  const auto& places = context.services->waiting_places;
  if (places.use_count() > static_cast<long>(limits::task::change_waiters))
    return nullptr;
  return places;
}

} // namespace

std::string mark_of(const task_description& task) {
  std::string text;
  for (const auto& row : task.tasks) {
    text += std::string{to_string(row.state)} + '\n' + std::to_string(row.run)
            + '\n' + std::to_string(row.revision) + '\n' + row.updating + '\n'
            + row.update_problem;
    for (const auto& x : row.instances)
      text += '\n' + x.spec.instance + '\t' + x.node + '\t'
              + std::string{to_string(x.state)} + '\t' + x.reason;
  }
  for (const auto& row : task.sets) {
    text += "\n" + std::to_string(row.nodes) + '\t'
            + std::to_string(row.running) + '\t' + std::to_string(row.pending);
    for (const auto& x : row.problems)
      text += '\n' + x.node + '\t' + x.reason;
  }
  return std::to_string(std::hash<std::string>{}(text));
}

void await_task_change(const request_context& context, task_change_query query,
                       outcome<task_change> done) {
  auto place = take_place(context);
  if (!place)
    return done.fail(failure{
        error_code::conflict,
        std::to_string(limits::task::change_waiters)
            + " already wait for changes of tasks",
        "", "ask again later, or follow the events of the coordinator"});
  const std::chrono::milliseconds wait{query.wait_ms};
  const auto waiter =
      spawn(context.self->system(), context.home(), task_change_waiter,
            context.home().events, context.services->coordinator, place);
  ask<task_change>(
      context, waiter, wait + 2 * limits::local::answer, std::move(query), done,
      [done](task_change reply) { done.deliver(std::move(reply)); });
}

} // namespace roscell
