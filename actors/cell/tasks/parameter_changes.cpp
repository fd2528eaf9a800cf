#include "actors/cell/tasks/parameter_changes.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/updates/update_guard.hpp"
#include "actors/placement/reading/changeable_parameters.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// A change from its request to its answer.
struct parameter_change_plan {
  deployment placed; ///< As it was when it was asked for.
  json wanted;       ///< The parameters that change.
  json former;       ///< What these were.
  json now;          ///< All of them.
  caf::typed_response_promise<parameters_changed> promise;
};

using plan_ptr = std::shared_ptr<parameter_change_plan>;

json parameters_in(const std::string& text) {
  auto result = json::parse(text, nullptr, false);
  return result.is_object() ? result : json::object();
}

std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// The build that an instance runs; none: nobody of the cell knows it.
std::optional<skill_descriptor> skill_of(const cell_coordinator_state& st,
                                         const deployment& x) {
  if (const auto* node = st.registry.find_name(x.node))
    for (const auto& skill : node->skills)
      if (skill.hash == x.spec.skill)
        return skill.descriptor;
  if (const auto build = st.builds.find(x.spec.skill))
    return build->skill.descriptor;
  return std::nullopt;
}

failure unfit(const deployment& x, const std::string& why,
              const std::string& hint) {
  return {error_code::conflict, "instance '" + x.spec.instance + "' " + why,
          "/instance", hint};
}

/// Why nothing can be changed of an instance now; null: it can.
std::optional<failure> why_not_changed(const cell_coordinator_state& st,
                                       const deployment& x) {
  if (auto why = why_updating(st, x.spec.task))
    return why;
  if (auto why = why_kept_by_set(st, x.spec.task, ""))
    return why;
  if (auto why = why_unsettled(st, x.spec.task))
    return why;
  const auto state = st.deployments.row_of(x).state;
  if (x.end || state != instance_state::running)
    return unfit(x, "does not run: it is " + std::string{to_word(state)},
                 x.end ? "`roscell apply` starts it with other parameters"
                       : "send it again when it runs");
  const auto* node = st.registry.find_name(x.node);
  if (!node || !node->agent)
    return failure{error_code::unreachable,
                   "node '" + x.node + "', on which instance '"
                       + x.spec.instance + "' is, is away",
                   "/instance", "send it again when it is back"};
  if (!requests_step(st.tasks.find(x.spec.task)->request, x.spec.step))
    return unfit(x,
                 "is one of several of its step, which have the same "
                 "parameters",
                 "change the task's file and `roscell apply` it");
  return std::nullopt;
}

/// Null: it can be carried out.
std::optional<failure> why_refused(const cell_coordinator_state& st,
                                   const parameter_change& request,
                                   const deployment& x) {
  if (auto why = why_not_changed(st, x))
    return why;
  if (st.pending.parameter_changes.count(request.instance) > 0)
    return unfit(x, "is being given other parameters by somebody else",
                 "send it again in a while");
  const auto skill = skill_of(st, x);
  if (!skill)
    return unfit(x, "runs a build that no node of the cell has any more",
                 "`roscell apply` restarts the step");
  return refused_parameters(*skill, x.spec.model,
                            parameters_in(request.parameters));
}

json only_named(const json& values, const json& names) {
  auto result = json::object();
  for (const auto& [name, value] : names.items())
    if (const auto found = values.find(name); found != values.end())
      result[name] = *found;
  return result;
}

parameters_changed reply_to_change(const parameter_change_plan& plan) {
  const auto& spec = plan.placed.spec;
  return {spec.instance,        spec.task,        spec.step, plan.placed.node,
          text_of(plan.former), text_of(plan.now)};
}

/// Tells a node what the task says. It need not answer: a node that is away
/// registers when it is back.
void restate(coordinator_pointer self, const deployment& x) {
  const auto* node = self->state.registry.find_name(x.node);
  if (!node || !node->agent)
    return;
  const auto ignore = [](const caf::error&) {};
  self->request(node->agent, limits::task::agent_parameters,
                set_parameters{x.spec.instance, x.spec.parameters})
      .then([](const parameters_set&) {}, ignore);
}

/// The change is over, one way or the other.
/// @param put_back The program may work with what is not written down.
void close_change(coordinator_pointer self, const plan_ptr& plan,
                  bool put_back) {
  auto& changes = self->state.pending.parameter_changes;
  const auto& instance = plan->placed.spec.instance;
  const auto found = changes.find(instance);
  const bool restates =
      put_back || (found != changes.end() && found->second.restate);
  changes.erase(instance);
  const auto* placed = self->state.deployments.find(instance);
  if (restates && placed && !placed->end)
    restate(self, *placed);
}

void on_written(coordinator_pointer self, const plan_ptr& plan) {
  const auto& spec = plan->placed.spec;
  close_change(self, plan, false);
  publish_task_event(self, events::parameters_changed, spec.task, spec.instance,
                     {{"task", spec.task},
                      {"step", spec.step},
                      {"node", plan->placed.node},
                      {"parameters", short_values(plan->wanted)},
                      {"former", short_values(plan->former)}});
  plan->promise.deliver(reply_to_change(*plan));
}

void put_back(coordinator_pointer self, const plan_ptr& plan, failure why) {
  close_change(self, plan, true);
  why.message += "; the parameters of instance '" + plan->placed.spec.instance
                 + "' are put back";
  plan->promise.deliver(to_error(why));
}

/// The program works with them. Meanwhile the instance may have ended, or its
/// task be terminated or changed by somebody else.
void write_down(coordinator_pointer self, const plan_ptr& plan) {
  auto& st = self->state;
  const auto& spec = plan->placed.spec;
  const auto* placed = st.deployments.find(spec.instance, plan->placed.node);
  if (!placed || placed->end)
    return put_back(self, plan, unfit(plan->placed, "has ended meanwhile", ""));
  auto why = why_updating(st, spec.task);
  if (!why)
    why = why_unsettled(st, spec.task);
  if (why)
    return put_back(self, plan, *why);
  pending_change change;
  change.still = &task_table::is_running;
  change.make = [step = spec.step, values = plan->wanted](task_record record) {
    return with_parameters(std::move(record), step, values);
  };
  change.done = [self, plan](const completion& kept) {
    if (kept)
      on_written(self, plan);
    else
      put_back(self, plan, kept.error());
  };
  change_task(self, spec.task, std::move(change));
}

/// What the program has said no to it does not work with; of what is not known
/// it may.
void on_not_set(coordinator_pointer self, const plan_ptr& plan,
                const caf::error& error) {
  const auto why = to_failure(error);
  close_change(self, plan, why.code != error_code::conflict);
  plan->promise.deliver(error);
}

} // namespace

caf::result<parameters_changed>
change_parameters(coordinator_pointer self, const parameter_change& request) {
  auto& st = self->state;
  const auto* placed = st.deployments.find(request.instance);
  if (!placed)
    return fail(error_code::unknown_task,
                "there is no instance '" + request.instance + "'", "/instance",
                "`roscell instances` lists them");
  if (auto why = why_refused(st, request, *placed))
    return to_error(*why);
  auto plan = std::make_shared<parameter_change_plan>();
  plan->placed = *placed;
  plan->wanted = parameters_in(request.parameters);
  const auto before = parameters_in(placed->spec.parameters);
  plan->former = only_named(before, plan->wanted);
  plan->now = before;
  plan->now.update(plan->wanted);
  if (plan->now == before)
    return reply_to_change(*plan);
  plan->promise = self->make_response_promise<parameters_changed>();
  st.pending.parameter_changes[request.instance] = {placed->spec.task, false};
  self->request(st.registry.find_name(placed->node)->agent,
                limits::task::agent_parameters,
                set_parameters{request.instance, text_of(plan->now)})
      .then([self, plan](const parameters_set&) { write_down(self, plan); },
            [self, plan](const caf::error& error) {
              on_not_set(self, plan, error);
            });
  return plan->promise;
}

void restate_parameters(coordinator_pointer self,
                        const node_registration& node) {
  auto& st = self->state;
  for (const auto& row : node.instances) {
    const auto* placed =
        st.deployments.find(row.spec.instance, node.identity.name);
    if (!placed || placed->end || !is_live(row.state)
        || !st.tasks.is_kept(placed->spec.task))
      continue;
    auto& changes = st.pending.parameter_changes;
    if (const auto found = changes.find(row.spec.instance);
        found != changes.end()) {
      found->second.restate = true;
      continue;
    }
    const auto skill = skill_of(st, *placed);
    if (skill && has_changeable_parameter(*skill, placed->spec.model))
      restate(self, *placed);
  }
}

} // namespace roscell
