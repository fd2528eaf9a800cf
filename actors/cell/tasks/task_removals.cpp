#include "actors/cell/tasks/task_removals.hpp"

#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/house/limits.hpp"

#include <memory>
#include <set>

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
      st.desk.removals.add({node, task, x.spec.instance}, self->clock().now());
  set_timer(self);
}

} // namespace

void remove_everywhere(
    coordinator_pointer self, const std::string& task,
    const std::vector<std::string>& also_on,
    const std::function<void(const std::vector<std::string>& away)>& done) {
  struct tally {
    size_t open = 1;
    std::set<std::string> away;
  };
  auto state = std::make_shared<tally>();
  auto count_down = [state, done] {
    if (--state->open == 0)
      done({state->away.begin(), state->away.end()});
  };
  for (const auto& node : nodes_of(self->state, task, also_on)) {
    const auto* entry = self->state.registry.find_name(node);
    if (!entry || !entry->agent) {
      state->away.insert(node);
      continue;
    }
    ++state->open;
    self->request(entry->agent, limits::task::removal_answer,
                  instance_removal{task, ""})
        .then([count_down](const instances_removed&) { count_down(); },
              [self, task, node, state, count_down](const caf::error&) {
                state->away.insert(node);
                remember_overdue(self, task, node);
                count_down();
              });
  }
  count_down();
}

void remove_instance(coordinator_pointer self, const overdue_removal& what,
                     const std::function<void()>& done) {
  const auto* entry = self->state.registry.find_name(what.node);
  // A node that is away is told what to stop when it registers.
  if (!entry || !entry->agent) {
    self->state.desk.removals.settle(what);
    return done();
  }
  self->request(entry->agent, limits::task::removal_answer,
                instance_removal{what.task, what.instance})
      .then(
          [self, what, done](const instances_removed&) {
            self->state.desk.removals.settle(what);
            done();
          },
          [self, what, done](const caf::error&) {
            self->state.desk.removals.add(what, self->clock().now());
            set_timer(self);
            done();
          });
}

void ask_overdue_removals(coordinator_pointer self) {
  for (const auto& x : self->state.desk.removals.take_due(self->clock().now()))
    remove_instance(self, x, [] {});
}

} // namespace roscell
