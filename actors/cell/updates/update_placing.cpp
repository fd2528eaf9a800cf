#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/cell/updates/update_run.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/reservation.hpp"

#include <algorithm>
#include <map>
#include <utility>

/// Places for what an update starts.
namespace roscell {

namespace {

using node_list = std::vector<node_resources>;

node_resources* find_node(node_list& nodes, const std::string& name) {
  for (auto& x : nodes)
    if (x.name == name)
      return &x;
  return nullptr;
}

void free_room(node_list& nodes, const deployment& x) {
  if (auto* node = find_node(nodes, x.node); node && !x.end)
    unreserve(*node, x.spec.resources, x.spec.gpu);
}

/// The nodes as they are once all that is to end has ended.
node_list nodes_without_old(const update_plan& plan, node_list nodes) {
  for (const auto& x : plan.steps)
    if (x.is_fresh() && x.old)
      free_room(nodes, *x.old);
  for (const auto& x : plan.dropped)
    free_room(nodes, x);
  return nodes;
}

/// What is to be placed. Who stays on his node surprises nobody.
std::vector<resolved_step> steps_to_place(const update_plan& plan,
                                          bool where_they_are) {
  std::vector<resolved_step> result;
  for (const auto& x : plan.steps) {
    if (!x.is_fresh())
      continue;
    result.push_back(x.step);
    if (!where_they_are || x.change.action != step_action::restarts)
      continue;
    for (auto& build : result.back().builds) {
      const auto& nodes = build.nodes;
      const bool has = std::count(nodes.begin(), nodes.end(), x.old->node) > 0;
      build.nodes = has ? std::vector<std::string>{x.old->node}
                        : std::vector<std::string>{};
    }
  }
  return result;
}

/// Where each step of the request is to be, those that stay too: what reads of
/// each other is named by that.
allocated_task whole_task(const update_run& run, const task_plan& found) {
  allocated_task result;
  result.request = run.request;
  size_t next = 0;
  for (const auto& x : run.plan.steps) {
    result.steps.push_back(x.step);
    if (x.is_fresh()) {
      result.plan.allocations.push_back(found.allocations[next++]);
      continue;
    }
    step_allocation place;
    place.step = x.step.step.id;
    place.node = x.old->node;
    result.plan.allocations.push_back(place);
  }
  return result;
}

/// The new instances, one a step that has one.
std::vector<instance_spec> fresh_specs(const cell_coordinator_state& st,
                                       const allocated_task& whole,
                                       const update_plan& plan) {
  std::vector<instance_spec> result;
  for (size_t i = 0; i < plan.steps.size(); ++i) {
    const auto& x = plan.steps[i];
    if (!x.is_fresh()) {
      result.push_back(x.old->spec);
      continue;
    }
    allocated_task alone;
    alone.request = whole.request;
    alone.steps = {whole.steps[i]};
    alone.plan.allocations = {whole.plan.allocations[i]};
    result.push_back(make_specs(alone).front());
    complete_spec(st, result.back());
  }
  name_upstream_steps(result);
  return result;
}

/// How far down the flow of data each step is.
std::map<std::string, size_t>
ranks_of(const std::vector<instance_spec>& specs) {
  std::vector<instance_row> rows;
  for (const auto& spec : specs) {
    rows.emplace_back();
    rows.back().spec = spec;
  }
  sort_by_flow(rows);
  std::map<std::string, size_t> result;
  for (const auto& x : rows)
    result.emplace(x.spec.step, result.size());
  return result;
}

/// Whether a new instance has room beside all that runs but the one that it
/// replaces.
bool has_room_now(const node_list& nodes, const replaced_step& x) {
  auto now = nodes;
  auto* node = find_node(now, x.fresh_node);
  if (!node)
    return true;
  if (x.old && x.old_node == x.fresh_node)
    unreserve(*node, x.old->resources, x.old->gpu);
  read_with_cpu_floor(*node);
  return shortages(*node, x.fresh->resources, x.fresh->gpu).empty();
}

void add_fresh_steps(update_run& run, const std::vector<instance_spec>& specs,
                     const allocated_task& whole, const node_list& nodes) {
  auto ranks = ranks_of(specs);
  for (size_t i = 0; i < specs.size(); ++i) {
    auto& planned = run.plan.steps[i];
    if (!planned.is_fresh())
      continue;
    replaced_step x;
    if (planned.old && !planned.old->end) {
      x.old = planned.old->spec;
      x.old_node = planned.old->node;
    }
    x.fresh = specs[i];
    x.fresh_node = whole.plan.allocations[i].node;
    x.rank = ranks[specs[i].step];
    x.needs_room = !has_room_now(nodes, x);
    planned.change.to = x.fresh_node;
    if (planned.old)
      planned.change.action = x.fresh_node == planned.old->node
                                  ? step_action::restarts
                                  : step_action::moves;
    run.steps.push_back(std::move(x));
    run.places.push_back(whole.plan.allocations[i]);
  }
}

void add_dropped_steps(update_run& run) {
  for (const auto& old : run.plan.dropped) {
    if (old.end)
      continue;
    replaced_step x;
    x.old = old.spec;
    x.old_node = old.node;
    run.steps.push_back(std::move(x));
    run.places.emplace_back();
  }
}

void adopt_places(const cell_coordinator_state& st, update_run& run,
                  const task_plan& found, const node_list& nodes) {
  const auto whole = whole_task(run, found);
  add_fresh_steps(run, fresh_specs(st, whole, run.plan), whole, nodes);
  add_dropped_steps(run);
  run.cpu_floor = found.cpu_floor;
  run.waves = update_waves(run.steps);
}

void search(coordinator_pointer self, const update_ptr& run, node_list nodes,
            bool where_they_are, const completion_handler& next) {
  allocate_task question;
  question.task = task_of(*run);
  question.steps = steps_to_place(run->plan, where_they_are);
  question.nodes = nodes_without_old(run->plan, nodes);
  question.trial = run->id == 0;
  if (question.steps.empty()) {
    adopt_places(self->state, *run, {}, nodes);
    return next({});
  }
  self->request(self->state.setup.scheduler, limits::local::answer,
                std::move(question))
      .then(
          [self, run, nodes, next](const task_plan& found) {
            adopt_places(self->state, *run, found, nodes);
            next({});
          },
          [self, run, nodes, where_they_are, next](const caf::error& err) {
            auto why = to_failure(err);
            if (where_they_are
                && why.code == error_code::no_feasible_allocation)
              return search(self, run, nodes, false, next);
            next(std::move(why));
          });
}

} // namespace

std::vector<replacement> replacements_of(const update_run& run) {
  std::vector<replacement> result;
  for (size_t i = 0; i < run.steps.size(); ++i)
    if (const auto& x = run.steps[i]; x.fresh)
      result.push_back(
          {x.old ? x.old->instance : std::string{}, *x.fresh, run.places[i]});
  return result;
}

void place_update(coordinator_pointer self, const update_ptr& run,
                  const completion_handler& next) {
  collect_resources_of_cell(self, [self, run, next](cell_resources&& found) {
    search(self, run, std::move(found.nodes), true, next);
  });
}

} // namespace roscell
