#include "actors/cell/moves/abandoned_steps.hpp"

#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// Whether it is still to be placed anew.
bool is_lost(const cell_coordinator_state& st, const abandoned_step& x) {
  return st.failures.find_abandoned(x.instance) && st.tasks.is_running(x.task)
         && st.deployments.find(x.instance, x.node);
}

void postpone(coordinator_pointer self,
              const std::vector<abandoned_step>& steps, const failure& why) {
  for (const auto& x : steps) {
    auto& failures = self->state.failures;
    const auto* known = failures.find_abandoned(x.instance);
    const bool news = known && known->problem != why.message;
    failures.postpone(x.instance, why.message, self->clock().now());
    if (news)
      publish_task_event(
          self, events::step_stranded, x.task, x.instance,
          {{"task", x.task}, {"node", x.node}, {"reason", why.message}});
  }
  set_timer(self);
}

void retry_placement(coordinator_pointer self,
                     const std::vector<abandoned_step>& steps) {
  auto move = std::make_shared<task_move>();
  move->what = "the lost steps of task '" + steps.front().task + "'";
  move->kind = move_kind::lost;
  move->done = [self, steps](const completion& placed) {
    if (!placed)
      postpone(self, steps, placed.error());
  };
  take_placement_lock(
      self, caf::actor_addr{}, [self, move, steps](uint64_t placement_lock) {
        move->placement_lock = placement_lock;
        const auto& st = self->state;
        for (const auto& x : steps) {
          if (!is_lost(st, x))
            continue;
          const auto request = request_of(*st.tasks.find(x.task));
          if (!request)
            return fail_move(self, move, without_request(x.task));
          if (auto why = add_moved_step(self, *move, *request,
                                        *st.deployments.find(x.instance),
                                        x.stays ? x.node : ""))
            return fail_move(self, move, *why);
        }
        run_move(self, move);
      });
}

/// Steps that are being placed anew, once nothing of them is left.
struct clearing {
  std::vector<abandoned_step> steps;
  size_t open = 1;
  std::optional<failure> problem; ///< The last.
};

void end_one(coordinator_pointer self, const std::shared_ptr<clearing>& x) {
  if (--x->open > 0)
    return;
  if (x->problem)
    postpone(self, x->steps, *x->problem);
  else
    retry_placement(self, x->steps);
}

/// Where its node lives after all, as its new place has come to nothing, what
/// is there has to be gone before.
void clear_and_place(coordinator_pointer self,
                     const std::vector<abandoned_step>& steps) {
  auto all = std::make_shared<clearing>();
  all->steps = steps;
  for (const auto& x : steps) {
    const auto* entry = self->state.registry.find_name(x.node);
    if (!entry || !entry->agent || entry->row.identity.uuid != x.uuid)
      continue;
    ++all->open;
    self->request(entry->agent, limits::task::removal_answer,
                  instance_removal{x.task, x.instance, false})
        .then(
            [self, all, x](const instances_removed& reply) {
              if (reply.waiting.empty())
                note_gone(self, x.uuid, x.instance);
              else
                all->problem = {error_code::conflict,
                                "the old instance is not stop-safe yet"};
              end_one(self, all);
            },
            [self, all](const caf::error& why) {
              all->problem = to_failure(why);
              end_one(self, all);
            });
  }
  end_one(self, all);
}

/// Nothing is heard of it any more. Another machine may have the name of its
/// node by now.
void abandon_step(cell_coordinator_state& st, const deployment& x,
                  const std::string& uuid,
                  std::chrono::steady_clock::time_point since,
                  std::chrono::steady_clock::time_point now) {
  const auto* place = st.failures.find(x.spec.instance, now);
  if (place && place->uuid != uuid)
    return;
  abandoned_step lost{x.spec.task, x.spec.step, x.spec.instance,
                      x.node,      uuid,        since + fence_of(x.spec)};
  lost.is_alone = !may_move(x.spec);
  if (may_move(x.spec) || starts_alone(x.spec))
    st.failures.abandon(std::move(lost));
}

} // namespace

void abandon_steps_of(coordinator_pointer self, const std::string& node,
                      const std::string& uuid,
                      std::chrono::steady_clock::time_point since) {
  auto& st = self->state;
  st.failures.node_lost(uuid, since);
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& x : st.deployments.of_task(task))
      if (x.node == node && !x.end && !x.tentative)
        abandon_step(st, x, uuid, since, self->clock().now());
  set_timer(self);
}

void abandon_steps_of_all(coordinator_pointer self) {
  auto& st = self->state;
  std::vector<std::pair<std::string, std::string>> nodes;
  st.registry.for_each([&](registry_entry& entry) {
    const auto& who = entry.row.identity;
    if (who.uuid != st.setup.self.uuid)
      nodes.emplace_back(who.name, who.uuid);
  });
  for (const auto& [name, uuid] : nodes)
    abandon_steps_of(self, name, uuid, self->clock().now());
}

void find_steps_of(coordinator_pointer self, const node_registration& node) {
  auto& st = self->state;
  std::set<std::string> live;
  for (const auto& x : node.instances)
    if (is_live(x.state))
      live.insert(x.spec.instance);
  st.failures.node_back(node.identity.uuid, live);
  for (const auto& x : node.instances)
    note_reported(self, x, node.identity.name);
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& x : st.deployments.of_task(task)) {
      const auto& instance = x.spec.instance;
      if (x.node == node.identity.name && !st.failures.is_abandoned(instance)
          && !is_elsewhere(st, instance, node.identity.uuid)) {
        st.failures.forget(instance);
        st.deployments.heed_end(instance);
      }
    }
}

bool is_elsewhere(const cell_coordinator_state& st, const std::string& instance,
                  const std::string& uuid) {
  const auto* lost = st.failures.find_abandoned(instance);
  return lost && lost->uuid != uuid;
}

void abandon_own_start(coordinator_pointer self, const deployment& x,
                       const std::string& uuid) {
  abandoned_step lost{x.spec.task, x.spec.step, x.spec.instance,
                      x.node,      uuid,        self->clock().now()};
  lost.stays = !may_move(x.spec);
  lost.problem = "another instance of it may still run elsewhere";
  self->state.failures.abandon(std::move(lost));
  // What is there of it ends, and that is no end of its work.
  self->state.deployments.ignore_end(x.spec.instance);
  set_timer(self);
}

void move_abandoned_steps(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& [task, steps] : st.failures.due(self->clock().now())) {
    std::vector<abandoned_step> wanted;
    for (const auto& x : steps) {
      if (!is_lost(st, x)) {
        st.failures.forget(x.instance);
        continue;
      }
      wanted.push_back(x);
      // It is due again only after this attempt.
      st.failures.pause(x.instance,
                        self->clock().now() + limits::task::deployment_answer);
    }
    if (!wanted.empty())
      clear_and_place(self, wanted);
  }
}

std::string wait_of_lost(const cell_coordinator_state& st,
                         const instance_row& row) {
  const auto* x = st.failures.find_abandoned(row.spec.instance);
  if ((!x || x->is_alone) && !st.deployments.find(row.spec.instance))
    return "no longer wanted, ends once node '" + row.node + "' is back";
  if (!x)
    return "waits for node '" + row.node + "'";
  if (x->is_alone)
    return "waits for node '" + row.node + "', which may start it alone";
  if (!x->problem.empty())
    return "waits for a place: " + x->problem;
  return "moves unless node '" + row.node + "' is back within "
         + std::to_string(fence_of(row.spec).count() / 1000) + " s";
}

} // namespace roscell
