#include "actors/instances/container_supervisor.hpp"

#include "actors/core/clocks.hpp"
#include "actors/instances/container_supervisor_steps.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using container_supervisor_self =
    container_supervisor_actor::stateful_pointer<container_supervisor_state>;

/// Empty if the node can run such an instance.
caf::error check(container_supervisor_self self, const instance_spec& spec) {
  const auto& st = self->state;
  if (!is_instance_id(spec.instance))
    return fail(error_code::schema_violation,
                "an instance id of letters, digits, '_', '-' and '.' is needed",
                "/spec/instance");
  const auto folder = st.config.skills->get()->find(spec.skill);
  if (folder == nullptr)
    return fail(error_code::unknown_operation,
                "node '" + st.config.node + "' has no skill "
                    + spec.skill.substr(0, 12) + " for '" + spec.operation
                    + "'",
                {}, "`roscell skills` shows which nodes have it");
  const auto& models = folder->skill.descriptor.models;
  const auto named = [](const std::string& name) {
    return [&](const auto& x) { return x.name == name; };
  };
  const auto model =
      std::find_if(models.begin(), models.end(), named(spec.model));
  if (model == models.end())
    return fail(error_code::unknown_model,
                "the skill has no model '" + spec.model + "'", "/spec/model");
  const auto& options = model->deployments;
  if (std::none_of(options.begin(), options.end(), named(spec.deployment)))
    return fail(error_code::unknown_deployment,
                "the model has no deployment '" + spec.deployment + "'",
                "/spec/deployment");
  const auto live =
      std::count_if(st.instances.begin(), st.instances.end(),
                    [](const auto& x) { return is_live(x.second.row.state); });
  if (static_cast<size_t>(live) >= limits::instance::most)
    return fail(error_code::conflict,
                "node '" + st.config.node + "' runs "
                    + std::to_string(limits::instance::most)
                    + " instances already");
  return {};
}

caf::result<instance_deployed> begin(container_supervisor_self self,
                                     const instance_spec& spec) {
  if (auto error = check(self, spec))
    return error;
  auto& x = self->state.instances[spec.instance];
  x = supervised_instance{};
  x.row.spec = spec;
  x.skill = self->state.config.skills->get()->find(spec.skill);
  x.row.node = self->state.config.node;
  x.row.problem = self->state.problem;
  x.started_in = self->state.config.boot;
  x.began_unix_ms = unix_now_ms();
  x.confirmed = true;
  spawn_actor(self, x, false);
  auto promise = self->make_response_promise<instance_deployed>();
  x.deployers.push_back(promise);
  return promise;
}

caf::result<instance_deployed> deploy(container_supervisor_self self,
                                      const instance_spec& spec) {
  auto* x = find_instance(self, spec.instance);
  if (x == nullptr)
    return begin(self, spec);
  const auto id = "instance '" + spec.instance + "'";
  if (x->removing)
    return fail(error_code::conflict, id + " is being removed", {},
                "send the request again when it is gone");
  if (x->row.spec != spec)
    return fail(error_code::conflict, id + " is in use by another spec");
  switch (x->row.state) {
  case instance_state::failed:
    return begin(self, spec);
  case instance_state::running:
  case instance_state::stopped:
    // One that has done its work is not run twice.
    return instance_deployed{x->row};
  default: {
    auto promise = self->make_response_promise<instance_deployed>();
    x->deployers.push_back(promise);
    return promise;
  }
  }
}

caf::result<instance_description> describe(container_supervisor_self self,
                                           const instance_query& query) {
  instance_description result;
  for (const auto& [instance, x] : self->state.instances)
    if ((query.instance.empty() || query.instance == instance)
        && (query.task.empty() || query.task == x.row.spec.task))
      result.instances.push_back(x.row);
  if (!query.instance.empty() && result.instances.empty())
    return fail(error_code::unknown_task,
                "there is no instance '" + query.instance + "'", "/instance",
                "`roscell instances` lists them");
  return result;
}

json summary(const container_supervisor_state& st) {
  json states = json::object();
  size_t deployers = 0;
  for (const auto& [instance, x] : st.instances) {
    states[instance] = to_string(x.row.state);
    deployers += x.deployers.size();
  }
  return {{"instances", states},
          {"deployments_waiting", deployers},
          {"removals_waiting", st.removals.size()},
          {"runtime_deaths", st.runtime_deaths},
          {"runtime_problem", st.problem}};
}

void on_changed(container_supervisor_self self, const instance_row& row) {
  auto* x = find_instance(self, row.spec.instance);
  // What a killed actor has said is outdated: its successor looks for itself.
  if (x == nullptr || !x->actor || self->current_sender() != x->actor)
    return;
  const bool news =
      row.state != x->row.state || row.since_unix_ms != x->row.since_unix_ms;
  const auto before = std::exchange(x->row, row);
  // These are heard here. A step of the build is no word of the skill.
  x->row.problem = before.problem;
  x->row.metrics = before.metrics;
  if (before.state != instance_state::building
      || row.state == instance_state::building)
    x->row.status = before.status;
  const bool waits = row.unsafe_since_unix_ms != before.unsafe_since_unix_ms;
  const bool health =
      row.health != before.health || row.health_reason != before.health_reason;
  if ((news || waits || health) && self->state.listener)
    self->send(self->state.listener, instance_changed{x->row});
  if (x->removing && row.unsafe_since_unix_ms > 0)
    on_removal_waits(self, x->row);
  if (row.state == instance_state::running) {
    if (before.state != instance_state::running)
      x->metrics.begin_run();
    x->deaths = 0;
    for (auto& promise : std::exchange(x->deployers, {}))
      promise.deliver(instance_deployed{x->row});
  } else if (!is_live(row.state)) {
    on_ended(self, row.spec.instance, *x);
  }
}

/// What its skill says, and what the cell has to know of it unasked.
void hear_status(container_supervisor_self self, supervised_instance& x,
                 const instance_notified& event) {
  const auto now = self->clock().now();
  x.row.status = event.status;
  x.metrics.hear(event.status, now, event.frames, event.remark);
  x.row.metrics = x.metrics.known();
  if (x.row.state == instance_state::running && x.quiet.hear(x.row, now)
      && self->state.listener)
    self->send(self->state.listener, instance_changed{x.row});
}

void on_notified(container_supervisor_self self,
                 const instance_notified& event) {
  auto* x = find_instance(self, event.instance);
  if (x == nullptr || !x->actor)
    return;
  if (!event.status.empty())
    hear_status(self, *x, event);
  if (event.safe != safe_word::untold)
    x->row.safe = event.safe;
  if (event.parameters_wanted > 0)
    ask_for_parameters(self, x->row, event);
  self->send(x->actor, event);
}

void on_exited(container_supervisor_self self, const container_exited& event) {
  if (auto* x = find_instance(self, event.instance); x != nullptr && x->actor)
    self->send(x->actor, event);
}

caf::result<parameters_set> pass_parameters(container_supervisor_self self,
                                            const set_parameters& request) {
  auto* x = find_instance(self, request.instance);
  if (x == nullptr || !x->actor)
    return fail(error_code::unknown_task,
                "no instance '" + request.instance + "' runs here",
                "/instance");
  return self->delegate(x->actor, request);
}

void on_runtime_problem(container_supervisor_self self,
                        const std::string& problem) {
  auto& st = self->state;
  if (st.problem == problem)
    return;
  st.problem = problem;
  for (auto& [instance, x] : st.instances) {
    if (!is_live(x.row.state) && x.row.problem.empty())
      continue;
    x.row.problem = is_live(x.row.state) ? problem : std::string{};
    if (st.listener)
      self->send(st.listener, instance_changed{x.row});
  }
}

} // namespace

container_supervisor_actor::behavior_type
container_supervisor(container_supervisor_self self,
                     const container_supervisor_config& config) {
  self->state.config = config;
  self->state.environment = config.environment;
  self->state.knows_place = !config.learns_place;
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_down(self, down); });
  start_runtime(self);
  restore(self);
  end_strays(self);
  return {
      [self](const state_query&) { return state_of(summary(self->state)); },
      [self](const instance_deployment& x) { return deploy(self, x.spec); },
      [self](const instance_removal& x) { return remove_instances(self, x); },
      [self](const set_parameters& x) { return pass_parameters(self, x); },
      [self](const instance_query& x) { return describe(self, x); },
      [self](const log_query& x) { return read_log(self, x); },
      [self](const kept_logs_query& x) { return list_logs(self, x); },
      [self](const listen_to_instances& x) {
        self->state.listener = x.listener;
      },
      [self](const use_environment& x) { take_place(self, x); },
      [self](const contact_proven& x) { on_contact(self, x); },
      [self](const contact_lost&) { on_contact_lost(self); },
      [self](const ends_acknowledged& x) {
        acknowledge_ends(self, x.instances);
      },
      [self](const container_exited& x) { on_exited(self, x); },
      [self](const instance_notified& x) { on_notified(self, x); },
      [self](const runtime_problem_changed& x) {
        on_runtime_problem(self, x.message);
      },
      [self](const use_router& x) { self->state.router = x.router; },
      [self](const instance_changed& x) { on_changed(self, x.instance); },
  };
}

} // namespace roscell
