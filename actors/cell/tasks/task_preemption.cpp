#include "actors/cell/tasks/task_preemption.hpp"

#include "actors/cell/state/task_story.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_restart.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using outcome_handler = std::function<void(const failure*)>;

/// It is gone. Its task knows, and whoever asks for that task again starts it.
void record_eviction(coordinator_pointer self, const std::string& by,
                     const preempted_instance& x, const outcome_handler& done) {
  if (!is_surely_gone(self->state, x.node, x.instance)) {
    self->state.deployments.heed_end(x.instance);
    const failure why{error_code::conflict, "nobody knows whether '" + x.task
                                                + "/" + x.step + "' on node '"
                                                + x.node + "' has ended"};
    return done(&why);
  }
  record_forced_end(self, x.task, x.instance,
                    "it makes way for task '" + by + "'",
                    [self, by, x, done](const failure* why) {
                      auto& st = self->state;
                      if (!why)
                        st.desk.preempted[by].push_back(x);
                      done(nullptr);
                      // It was waited for too long, or the task was terminated
                      // meanwhile.
                      if (!st.tasks.is_deploying(by))
                        restore_preempted(self, by);
                    });
}

void evict(coordinator_pointer self, const make_way& wish,
           const preempted_instance& x, const outcome_handler& done) {
  auto& st = self->state;
  const auto* placed = st.deployments.find(x.instance, x.node);
  if (!placed || placed->end)
    return done(nullptr);
  st.deployments.ignore_end(x.instance);
  tell_of_task(self, "instance_preempted", x.task, x.instance,
               {{"task", x.task},
                {"step", x.step},
                {"node", x.node},
                {"priority", x.priority},
                {"by", wish.task}});
  remove_instance(
      self, {x.node, x.task, x.instance},
      [self, by = wish.task, x, done] { record_eviction(self, by, x, done); },
      wish.force);
}

void restore(coordinator_pointer self, const preempted_instance& x) {
  start_ended(self, x.task, {x.instance}, [self, x](const failure* why) {
    // A task that is gone needs no place.
    if (why && self->state.tasks.is_kept(x.task))
      tell_of_task(
          self, "step_stranded", x.task, x.instance,
          {{"task", x.task}, {"node", x.node}, {"reason", why->message}});
  });
}

} // namespace

std::vector<evictable_instance> evictable_in(const cell_coordinator_state& st) {
  std::vector<evictable_instance> result;
  for (const auto& [task, entry] : st.tasks.entries()) {
    if (!st.tasks.is_running(task))
      continue;
    for (const auto& x : st.deployments.of_task(task))
      if (!x.end && !x.tentative)
        result.push_back(
            {{x.spec.instance, task, x.spec.step, x.node, x.spec.life.priority},
             x.spec.resources,
             x.spec.gpu});
  }
  return result;
}

caf::result<way_made> clear_way(coordinator_pointer self,
                                const make_way& wish) {
  if (!self->state.tasks.is_deploying(wish.task))
    return terminated_meanwhile(wish.task);
  auto promise = self->make_response_promise<way_made>();
  struct tally {
    size_t open = 0;
    std::optional<failure> problem; ///< The last.
  };
  auto all = std::make_shared<tally>();
  all->open = wish.preempted.size() + 1;
  auto finish = [all, promise](const failure* why) mutable {
    if (why)
      all->problem = *why;
    if (--all->open > 0)
      return;
    if (all->problem)
      promise.deliver(to_error(*all->problem));
    else
      promise.deliver(way_made{});
  };
  for (const auto& x : wish.preempted)
    evict(self, wish, x, finish);
  finish(nullptr);
  return promise;
}

void restore_preempted(coordinator_pointer self, const std::string& task) {
  auto& known = self->state.desk.preempted;
  const auto found = known.find(task);
  if (found == known.end())
    return;
  auto gone = std::move(found->second);
  known.erase(found);
  std::stable_sort(gone.begin(), gone.end(), [](const auto& x, const auto& y) {
    return x.priority > y.priority;
  });
  for (const auto& x : gone)
    restore(self, x);
}

} // namespace roscell
