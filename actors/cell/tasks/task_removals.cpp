#include "actors/cell/tasks/task_removals.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

/// The nodes on which a task has something, and those on which room may be
/// kept for it.
std::set<std::string> nodes_of(const cell_coordinator_state& st,
                               const std::string& task,
                               const std::vector<std::string>& also_on) {
  std::set<std::string> result{also_on.begin(), also_on.end()};
  for (const auto& x : st.deployments.of_task(task))
    result.insert(x.node);
  return result;
}

/// A node that lives has not removed a task's instances in time.
void remember_overdue(coordinator_pointer self, const std::string& task,
                      const std::string& node) {
  auto& st = self->state;
  for (const auto& x : st.deployments.of_task(task))
    if (x.node == node)
      st.pending.removals.add({node, task, x.spec.instance},
                              self->clock().now());
  set_timer(self);
}

using time_point = std::chrono::steady_clock::time_point;

/// The instance ends by itself; it is asked for again when it has. It may have
/// before this was told, or its node be away by now.
void await_safety(coordinator_pointer self, const safety_wait& wait,
                  const std::function<void()>& done, time_point until) {
  auto& st = self->state;
  if (is_away(st, wait.node))
    return done();
  if (!st.failures.find(wait.instance, self->clock().now())) {
    st.pending.removals.add({wait.node, wait.task, wait.instance},
                            self->clock().now());
    set_timer(self);
    return done();
  }
  publish_task_event(self, events::instance_awaited, wait.task, wait.instance,
                     {{"task", wait.task},
                      {"step", wait.step},
                      {"node", wait.node},
                      {"until_unix_ms", wait.until_unix_ms}});
  st.pending.not_stop_safe.push_back({wait, done, until});
  set_timer(self);
}

/// A node has answered: all that it had of a task there has ended but this.
void note_removed(coordinator_pointer self, const std::string& uuid,
                  const std::string& task,
                  const std::vector<safety_wait>& waiting) {
  std::set<std::string> left;
  for (const auto& x : waiting)
    left.insert(x.instance);
  self->state.failures.end_all(uuid, task, left);
  forget_past_remains(self);
}

/// A task's removal, as the nodes answer.
struct removal_tally {
  task_removal request;
  size_t asked = 1; ///< Nodes that have not answered yet.
  size_t open = 1;  ///< These, and instances that are not stop-safe.
  std::set<std::string> away;
  std::vector<safety_wait> waiting;
};

void count_down(const std::shared_ptr<removal_tally>& tally) {
  if (--tally->open == 0)
    tally->request.done({tally->away.begin(), tally->away.end()});
}

void on_node_answered(const std::shared_ptr<removal_tally>& tally) {
  if (--tally->asked == 0 && !tally->waiting.empty() && tally->request.waits)
    tally->request.waits(tally->waiting);
  count_down(tally);
}

void ask_node(coordinator_pointer self, const registry_entry& entry,
              const std::shared_ptr<removal_tally>& tally) {
  const auto& task = tally->request.task;
  const auto& node = entry.row.identity.name;
  self->request(entry.agent, limits::task::removal_answer,
                instance_removal{task, "", tally->request.force})
      .then(
          [self, node, uuid = entry.row.identity.uuid,
           tally](const instances_removed& reply) {
            note_removed(self, uuid, tally->request.task, reply.waiting);
            for (auto wait : reply.waiting) {
              wait.node = node;
              ++tally->open;
              tally->waiting.push_back(wait);
              await_safety(
                  self, wait,
                  [self, node, tally] {
                    if (is_away(self->state, node))
                      tally->away.insert(node);
                    count_down(tally);
                  },
                  time_point::max());
            }
            on_node_answered(tally);
          },
          [self, task, node, tally](const caf::error&) {
            tally->away.insert(node);
            remember_overdue(self, task, node);
            on_node_answered(tally);
          });
}

void force_removal(coordinator_pointer self, const safety_wait& x) {
  remove_instance(
      self, {x.node, x.task, x.instance}, [] {}, true);
}

/// Those for whom `is_due` says so, taken out.
template <class Predicate>
std::vector<awaited_safety> take_waits(coordinator_pointer self,
                                       Predicate&& is_due) {
  auto& xs = self->state.pending.not_stop_safe;
  const auto due = std::stable_partition(
      xs.begin(), xs.end(), [&](const auto& x) { return !is_due(x.wait); });
  std::vector<awaited_safety> result{std::make_move_iterator(due),
                                     std::make_move_iterator(xs.end())};
  xs.erase(due, xs.end());
  return result;
}

} // namespace

bool is_away(const cell_coordinator_state& st, const std::string& node) {
  const auto* entry = st.registry.find_name(node);
  return !entry || !entry->agent;
}

void remove_everywhere(coordinator_pointer self, const task_removal& request) {
  auto tally = std::make_shared<removal_tally>();
  tally->request = request;
  for (const auto& node :
       nodes_of(self->state, request.task, request.also_on)) {
    if (is_away(self->state, node)) {
      tally->away.insert(node);
      continue;
    }
    ++tally->asked;
    ++tally->open;
    ask_node(self, *self->state.registry.find_name(node), tally);
  }
  on_node_answered(tally);
}

void remove_instance(coordinator_pointer self, const overdue_removal& what,
                     const std::function<void()>& done, bool force,
                     time_point until) {
  const auto* entry = self->state.registry.find_name(what.node);
  // A node that is away is told what to stop when it registers.
  if (!entry || !entry->agent) {
    self->state.pending.removals.settle(what);
    return done();
  }
  self->request(entry->agent, limits::task::removal_answer,
                instance_removal{what.task, what.instance, force})
      .then(
          [self, what, done, until,
           uuid = entry->row.identity.uuid](const instances_removed& reply) {
            self->state.pending.removals.settle(what);
            if (reply.waiting.empty()) {
              note_gone(self, uuid, what.instance);
              return done();
            }
            auto wait = reply.waiting.front();
            wait.node = what.node;
            await_safety(self, wait, done, until);
          },
          [self, what, done](const caf::error&) {
            self->state.pending.removals.add(what, self->clock().now());
            set_timer(self);
            done();
          });
}

void force_removals(coordinator_pointer self, const std::string& task) {
  const auto& st = self->state;
  std::set<std::string> waiting;
  for (const auto& x : safety_waits_of(st, task)) {
    waiting.insert(x.instance);
    force_removal(self, x);
  }
  // What has been asked politely to end has no more time for it.
  for (const auto& x : st.deployments.of_task(task))
    if (waiting.count(x.spec.instance) == 0
        && !is_surely_gone(self, x.spec.instance))
      remove_instance(
          self, {x.node, task, x.spec.instance}, [] {}, true);
}

void force_removals_on(coordinator_pointer self, const std::string& node) {
  const auto waits = self->state.pending.not_stop_safe;
  for (const auto& x : waits)
    if (x.wait.node == node)
      force_removal(self, x.wait);
}

std::vector<safety_wait> safety_waits_of(const cell_coordinator_state& st,
                                         const std::string& task) {
  std::vector<safety_wait> result;
  for (const auto& x : st.pending.not_stop_safe)
    if (x.wait.task == task)
      result.push_back(x.wait);
  return result;
}

void on_instance_gone(coordinator_pointer self, const std::string& node,
                      const std::string& instance) {
  const auto is_it = [&](const safety_wait& x) {
    return x.node == node && x.instance == instance;
  };
  // It has ended; what it has left is still to be removed.
  self->state.pending.removals.settle({node, "", instance});
  for (const auto& x : take_waits(self, is_it))
    remove_instance(self, {node, x.wait.task, instance}, [done = x.done] {
      if (done)
        done();
    });
}

void give_up_waits_on(coordinator_pointer self, const std::string& node) {
  for (const auto& x : take_waits(
           self, [&](const safety_wait& wait) { return wait.node == node; }))
    if (x.done)
      x.done();
}

void give_up_late_waits(coordinator_pointer self) {
  std::vector<std::function<void()>> late;
  for (auto& x : self->state.pending.not_stop_safe)
    if (x.until <= self->clock().now()) {
      // It is removed all the same when it has ended.
      x.until = time_point::max();
      late.push_back(std::exchange(x.done, nullptr));
    }
  for (const auto& done : late)
    done();
}

void ask_overdue_removals(coordinator_pointer self) {
  for (const auto& x :
       self->state.pending.removals.take_due(self->clock().now()))
    remove_instance(self, x, [] {});
}

} // namespace roscell
