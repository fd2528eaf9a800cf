#include "actors/cell/tasks/task_changes.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

using time_point = std::chrono::steady_clock::time_point;

/// What has happened is to be on disk soon after there is room: a coordinator
/// that ends before knows nothing of it. A write that fails costs little.
constexpr backoff::duration longest_wait_for_room{2000};

void write_next_change(coordinator_pointer self, const std::string& task);

/// The first change is over, one way or the other.
void end_change(coordinator_pointer self, const std::string& task,
                const completion& kept) {
  auto& line = self->state.pending.lines.at(task);
  line.writing = false;
  line.pause.reset();
  const auto change = std::move(line.changes.front());
  line.changes.pop_front();
  if (change.done)
    change.done(kept);
  write_next_change(self, task);
}

/// What was told to end and is no more, or has ended, is known to be so.
void follow_orders(coordinator_pointer self, const std::string& task,
                   const task_record& record) {
  auto& orders = self->state.orders;
  orders.keep_only(task, record.orders);
  for (const auto& x : record.ends)
    orders.end(x.instance, self->clock().now());
  if (orders.next_due() <= self->clock().now())
    wake(self);
}

void on_change_persisted(coordinator_pointer self, const std::string& task,
                         const std::optional<task_record>& record) {
  auto& st = self->state;
  if (record) {
    st.tasks.apply(*record);
    st.deployments.place(task, deployments_in(*record));
  } else {
    st.tasks.forget(task);
    st.deployments.forget_task(task);
  }
  follow_deadline(self, task);
  follow_orders(self, task, record ? *record : task_record{});
  look_at_sets(self);
  end_change(self, task, {});
}

void on_change_not_persisted(coordinator_pointer self, const std::string& task,
                             const failure& why) {
  auto& line = self->state.pending.lines.at(task);
  const auto& change = line.changes.front();
  if (!change.insistent)
    return end_change(self, task, why);
  line.writing = false;
  line.retry =
      self->clock().now() + std::min(line.pause.next(), longest_wait_for_room);
  set_timer(self);
  if (change.on_problem)
    change.on_problem(why);
}

void write_change(coordinator_pointer self, const std::string& task,
                  const std::optional<task_record>& record) {
  keep_records(
      self,
      {record ? store_record{"tasks", task, json(*record).dump()}
              : record_of_remains(self, task)},
      [self, task, record] { on_change_persisted(self, task, record); },
      [self, task](const failure& why) {
        on_change_not_persisted(self, task, why);
      });
}

/// A change that does not apply any more is not written.
void write_next_change(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  const auto i = st.pending.lines.find(task);
  if (i == st.pending.lines.end() || i->second.writing)
    return;
  auto& line = i->second;
  line.retry = time_point::max();
  if (line.changes.empty()) {
    st.pending.lines.erase(i);
    return;
  }
  line.writing = true;
  const auto& change = line.changes.front();
  if (!change.make)
    return write_change(self, task, std::nullopt);
  const auto* entry = st.tasks.find(task);
  if (!entry || (change.still && !(st.tasks.*change.still)(task))) {
    return end_change(self, task,
                      failure{error_code::conflict,
                              "task '" + task + "' was terminated meanwhile",
                              "/task"});
  }
  write_change(
      self, task,
      with_left(self, change.make(record_of(task, *entry, st.deployments))));
}

} // namespace

void follow_deadline(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  const auto* entry = st.tasks.find(task);
  st.deadlines.follow(task, entry ? entry->deadline_unix_ms : 0, unix_now_ms(),
                      self->clock().now());
  if (st.deadlines.next_due() != time_point::max())
    set_timer(self);
}

void change_task(coordinator_pointer self, const std::string& task,
                 pending_change change) {
  self->state.pending.lines[task].changes.push_back(std::move(change));
  write_next_change(self, task);
}

void retry_change(coordinator_pointer self, const std::string& task) {
  write_next_change(self, task);
}

void retry_due_changes(coordinator_pointer self) {
  std::vector<std::string> due;
  for (const auto& [task, line] : self->state.pending.lines)
    if (line.retry <= self->clock().now())
      due.push_back(task);
  for (const auto& task : due)
    write_next_change(self, task);
}

void rename_node(coordinator_pointer self, const std::string& from,
                 const std::string& to) {
  auto& st = self->state;
  const auto tasks = st.deployments.rename_node(from, to);
  if (const auto* entry = st.registry.find_name(to))
    st.failures.rename_node(entry->row.identity.uuid, to);
  st.context.publish_event(events::node_renamed, to,
                           {{"from", from}, {"tasks", json(tasks)}});
  for (const auto& task : tasks) {
    pending_change change;
    change.still = &task_table::is_kept;
    change.insistent = true;
    change.make = [from, to](task_record record) {
      return with_renamed(std::move(record), from, to);
    };
    change_task(self, task, std::move(change));
  }
}

void follow_own_name(coordinator_pointer self, const node_registration& own) {
  const auto& st = self->state;
  for (const auto& x : own.instances) {
    const auto* placed = st.deployments.find(x.spec.instance);
    if (placed && !st.registry.find_name(placed->node))
      rename_node(self, std::string{placed->node}, own.identity.name);
  }
}

} // namespace roscell
