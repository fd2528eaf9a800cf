#include "actors/builds/limits.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/updates/update_run.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/placement/limits.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <map>
#include <utility>

/// One wave of an update: its nodes get the builds that they lack, its old
/// instances end, its new ones start.
namespace roscell {

namespace {

using wave_handler = void (*)(coordinator_pointer, const update_ptr&);

/// Counts down the parts of a stage. What has been undone meanwhile, or whose
/// task was terminated, goes on no more.
void end_part(coordinator_pointer self, const update_ptr& run,
              update_stage stage, wave_handler next,
              const completion& done = {}) {
  if (!done && !run->problem)
    run->problem = done.error();
  if (--run->open > 0)
    return;
  auto& st = self->state;
  if (!st.tasks.is_running(task_of(*run)))
    return end_update(self, run);
  if (run->problem)
    return undo_update(self, run, *run->problem);
  if (st.updates.is_at(run->id, stage))
    next(self, run);
}

void publish_replaced(coordinator_pointer self, const update_run& run,
                      size_t i) {
  const auto& x = run.steps[i];
  const auto& spec = x.fresh ? *x.fresh : *x.old;
  json data{{"task", spec.task}, {"step", spec.step}};
  if (x.fresh) {
    data["instance"] = spec.instance;
    data["node"] = x.fresh_node;
  }
  if (x.old)
    data["replaces"] = x.old->instance;
  publish_task_event(self, events::step_replaced, spec.task, spec.task, data);
}

void start_step(coordinator_pointer self, const update_ptr& run, size_t part);

/// Others of the wave may have waited for this one alone, whose file they read.
void on_started(coordinator_pointer self, const update_ptr& run, size_t part) {
  if (!self->state.updates.is_at(run->id, update_stage::starting))
    return;
  publish_replaced(self, *run, wave_of(*run)[part]);
  for (size_t i = 0; i < run->before.size(); ++i) {
    auto& open = run->before[i];
    const auto waited = std::find(open.begin(), open.end(), part);
    if (waited == open.end())
      continue;
    open.erase(waited);
    if (open.empty())
      start_step(self, run, i);
  }
  end_part(self, run, update_stage::starting, settle_wave);
}

/// Why the new instance of a step must not be started now.
std::optional<failure> why_not_started(coordinator_pointer self,
                                       const replaced_step& x) {
  const auto& st = self->state;
  const auto& spec = *x.fresh;
  if (!st.deployments.find(spec.instance, x.fresh_node))
    return failure{error_code::conflict, "it is not wanted any more"};
  if (auto why = why_not_yet(
          self, {spec.task, spec.step, x.old ? x.old->instance : "", false}))
    return why;
  const auto* entry = st.registry.find_name(x.fresh_node);
  if (!entry || !entry->agent)
    return failure{error_code::conflict, "the node left meanwhile"};
  if (!note_start(self, spec, x.fresh_node))
    return failure{error_code::conflict, "too many instances are known"};
  return std::nullopt;
}

/// In between its node may be lost, or the task terminated: the request fails
/// then.
void start_step(coordinator_pointer self, const update_ptr& run, size_t part) {
  if (!self->state.updates.is_at(run->id, update_stage::starting))
    return;
  const auto i = wave_of(*run)[part];
  const auto& x = run->steps[i];
  // Nobody waits for the others: all of them go.
  const auto fail = [self, run, i](const failure& why) {
    undo_update(self, run, step_failure(*run, i, why));
  };
  if (!x.fresh)
    return on_started(self, run, part);
  if (auto why = why_not_started(self, x))
    return fail(*why);
  const auto& agent = self->state.registry.find_name(x.fresh_node)->agent;
  self->request(
          agent, limits::task::deployment_answer,
          instance_deployment{
              *x.fresh, offer_for(self->state, x.fresh->skill, x.fresh_node)})
      .then([self, run,
             part](const instance_deployed&) { on_started(self, run, part); },
            [fail](const caf::error& why) { fail(to_failure(why)); });
}

void start_wave(coordinator_pointer self, const update_ptr& run) {
  if (!self->state.updates.enter(run->id, update_stage::starting))
    return;
  std::vector<instance_spec> specs;
  for (const auto i : wave_of(*run))
    specs.push_back(run->steps[i].fresh.value_or(instance_spec{}));
  run->before = start_order(specs);
  const auto before = run->before;
  run->open = specs.size();
  for (size_t part = 0; part < specs.size(); ++part)
    if (before[part].empty())
      start_step(self, run, part);
}

void reserve_room(coordinator_pointer self, const update_ptr& run,
                  const std::string& node,
                  const instance_reservation& question) {
  const auto end_with = [self, run, node](const std::string& why) {
    end_part(self, run, update_stage::ending, start_wave,
             failure{error_code::no_feasible_allocation,
                     "node '" + node + "' has no room: " + why, "/pipeline",
                     "the nodes' resources change; send the request again"});
  };
  const auto* entry = self->state.registry.find_name(node);
  if (!entry || entry->row.state != row_state::active)
    return end_with("it left meanwhile");
  self->request(entry->agent, limits::task::reservation, question)
      .then(
          [self, run, end_with](const instances_reserved& reply) {
            if (!reply.refused.empty())
              return end_with(reply.refused.front().reason);
            end_part(self, run, update_stage::ending, start_wave);
          },
          [end_with](const caf::error& why) {
            end_with(to_failure(why).message);
          });
}

/// The old ones have ended. The nodes say whether there is room now: other
/// programs may have taken it.
void reserve_wave(coordinator_pointer self, const update_ptr& run) {
  std::map<std::string, instance_reservation> questions;
  for (const auto i : wave_of(*run))
    if (const auto& x = run->steps[i]; x.fresh) {
      auto& question = questions[x.fresh_node];
      question.task = task_of(*run);
      question.cpu_floor = run->cpu_floor;
      question.specs.push_back(*x.fresh);
    }
  run->open = questions.size() + 1;
  for (const auto& [node, question] : questions)
    reserve_room(self, run, node, question);
  end_part(self, run, update_stage::ending, start_wave);
}

/// In between it may end by itself, which is as good; its node may be lost, or
/// it may not be stop-safe for too long.
void end_old(coordinator_pointer self, const update_ptr& run, size_t i) {
  const auto& x = run->steps[i];
  const auto finish = [self, run](const completion& ended) {
    end_part(self, run, update_stage::ending, reserve_wave, ended);
  };
  const auto* placed =
      self->state.deployments.find(x.old->instance, x.old_node);
  if (!placed)
    return finish(failure{error_code::conflict,
                          "step '" + x.old->step + "' was moved meanwhile"});
  if (placed->end)
    return finish({});
  ordered_stop stop;
  stop.task = task_of(*run);
  stop.node = x.old_node;
  stop.order = {x.old->instance, "it was ended for an update of its task", "",
                5};
  stop.force = run->asked.force;
  stop.until = self->clock().now() + limits::task::eviction;
  stop.has_successor = true;
  stop.still = [self, id = run->id] {
    return self->state.updates.is_at(id, update_stage::ending);
  };
  stop.done = [finish](stop_outcome, const completion& ended) {
    finish(ended);
  };
  stop_by_order(self, stop);
}

void end_wave(coordinator_pointer self, const update_ptr& run) {
  if (!self->state.updates.enter(run->id, update_stage::ending))
    return;
  std::vector<size_t> ending;
  for (const auto i : wave_of(*run))
    if (run->steps[i].old)
      ending.push_back(i);
  run->open = ending.size() + 1;
  for (const auto i : ending)
    end_old(self, run, i);
  end_part(self, run, update_stage::ending, reserve_wave);
}

void bring_build(coordinator_pointer self, const update_ptr& run,
                 const std::string& node, const build_offer& offer) {
  const auto finish = [self, run, node](const completion& fetched) {
    end_part(self, run, update_stage::fetching, end_wave, fetched);
  };
  const auto* entry = self->state.registry.find_name(node);
  if (!entry || !entry->agent)
    return finish(
        failure{error_code::unreachable, "node '" + node + "' left meanwhile"});
  self->request(entry->agent, limits::build::keeping_answer,
                build_keeping{self->state.setup.cell, offer, false})
      .then([finish](const build_kept&) { finish({}); },
            [finish, node](const caf::error& err) {
              auto why = to_failure(err);
              why.message =
                  "node '" + node + "' does not get the build: " + why.message;
              finish(why);
            });
}

} // namespace

void begin_wave(coordinator_pointer self, const update_ptr& run) {
  // Nothing ends for what is not there yet.
  std::map<std::pair<std::string, std::string>, build_offer> lacking;
  for (const auto i : wave_of(*run))
    if (const auto& x = run->steps[i]; x.fresh)
      if (auto offer = offer_for(self->state, x.fresh->skill, x.fresh_node);
          !offer.build.hash.empty())
        lacking[{x.fresh_node, x.fresh->skill}] = std::move(offer);
  run->open = lacking.size() + 1;
  for (const auto& [where, offer] : lacking)
    bring_build(self, run, where.first, offer);
  end_part(self, run, update_stage::fetching, end_wave);
}

} // namespace roscell
