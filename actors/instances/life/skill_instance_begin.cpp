#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/life/runtime_switch.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/limits.hpp"
#include "actors/instances/ros2/ros2_program.hpp"
#include "messages/event_kinds.hpp"

#include <csignal>
#include <utility>

namespace roscell {

namespace {

const deployment_option* find_deployment(const skill_folder& folder,
                                         const instance_spec& spec) {
  for (const auto& model : folder.skill.descriptor.models)
    if (model.name == spec.model)
      for (const auto& option : model.deployments)
        if (option.name == spec.deployment)
          return &option;
  return nullptr;
}

/// A folder of the same content may be elsewhere by now. One that was edited is
/// another build, so this one is what it was: what runs of it needs no more,
/// and a new start of it is refused by who looks into the folder.
shared_skill_folder folder_of(const skill_instance_state& st) {
  auto present = st.config.skills->get()->find(st.row.spec.skill);
  return present ? present : st.config.skill;
}

/// What is run, and how.
struct program_plan {
  std::vector<std::string> command;
  std::map<std::string, std::string> environment; ///< Before the contract's.
  int stop_signal = SIGTERM;
};

/// Why the deployment cannot be run as it asks to be; empty: it can. What is
/// granted may have changed since it was placed here.
std::string not_granted(const skill_instance_state& st,
                        const deployment_option& option) {
  const auto granted = st.config.grants ? *st.config.grants : skill_grants{};
  const auto& skill = st.row.spec.operation;
  const auto missing = granted.missing(skill, option);
  return missing.empty() ? std::string{}
                         : refusal_text(skill, st.config.node, missing.front());
}

/// Passes on what the deployment asks for, of which all is granted.
void grant(const skill_instance_state& st, const deployment_option& option,
           start_container& request) {
  request.capabilities = option.capabilities;
  request.scheduling = option.scheduling;
  request.read_only = option.read_only;
  if (st.config.grants)
    request.user = st.config.grants->user_of(st.row.spec.operation);
}

void on_built(skill_instance_pointer self, const std::string& image,
              const program_plan& program, const deployment_option& option,
              const secrets_laid_out& secrets) {
  auto& st = self->state;
  const auto& spec = st.row.spec;
  st.row.image = image;
  st.started_at = st.config.address;
  st.started_in = st.config.boot;
  if (!may_start(self)) {
    drop_secrets(self);
    return wait_for_contact(self);
  }
  enter(self, instance_state::starting);
  start_container request;
  request.instance = spec.instance;
  request.image = image;
  request.command = program.command;
  request.stop_signal = program.stop_signal;
  request.environment = instance_environment(with_values(spec, secrets), option,
                                             st.config.environment);
  request.secrets_folder = secrets.folder;
  request.environment.insert(program.environment.begin(),
                             program.environment.end());
  request.labels = {
      {"task", spec.task}, {"instance", spec.instance}, {"cell", spec.cell}};
  request.limits = spec.resources;
  request.gpu = spec.gpu;
  request.input = spec.input;
  request.output = spec.output;
  request.devices = option.devices;
  request.volumes = option.volumes;
  grant(st, option, request);
  request.fence_boot_ms = st.fence_boot_ms = fence_of(st);
  ask<container_started>(
      self, st.config.runtime, limits::instance::start, request,
      [=](const container_started& x) { on_started(self, x.container); },
      [=](const caf::error& error) {
        take_down(self, instance_state::failed, sentence(error));
      });
}

/// A stock program's own way of ending is the one that ROS 2 knows. None, with
/// the instance concluded, when it cannot be run as this step.
std::optional<program_plan> program_of(skill_instance_pointer self,
                                       const skill_descriptor& descriptor) {
  auto& st = self->state;
  if (descriptor.ros2.empty()) {
    program_plan result{descriptor.entry_point, {}};
    if (auto changeable = changeable_parameters(descriptor, st.row.spec.model);
        !changeable.empty())
      result.environment["ROSCELL_CHANGEABLE"] = std::move(changeable);
    result.command.insert(result.command.end(), st.row.spec.arguments.begin(),
                          st.row.spec.arguments.end());
    return result;
  }
  auto start = ros2_start_of(descriptor, st.row.spec);
  if (const auto* why = std::get_if<failure>(&start)) {
    conclude(self, instance_state::failed, sentence(to_error(*why)));
    return std::nullopt;
  }
  auto& x = std::get<ros2_start>(start);
  st.endpoints = x.endpoints;
  return program_plan{std::move(x.command), std::move(x.environment), SIGINT};
}

} // namespace

void build(skill_instance_pointer self) {
  auto& st = self->state;
  // What a record says of the cell's server may be of an earlier day.
  st.awaits_place = !st.config.knows_place;
  if (st.awaits_place) {
    st.row.waits = "waits to hear where its cell is";
    return report(self);
  }
  const auto folder = folder_of(st);
  const auto* option =
      folder != nullptr ? find_deployment(*folder, st.row.spec) : nullptr;
  if (option == nullptr)
    return conclude(self, instance_state::failed,
                    "this node does not have its skill any more");
  if (const auto why = not_granted(st, *option); !why.empty())
    return conclude(self, instance_state::failed, why);
  const auto& descriptor = folder->skill.descriptor;
  if (folder->in_process)
    return with_secrets(self,
                        [=, image = actor_image(descriptor.operation),
                         chosen = *option](const secrets_laid_out& secrets) {
                          on_built(self, image, {}, chosen, secrets);
                        });
  const auto program = program_of(self, descriptor);
  if (!program)
    return;
  if (st.config.builds_images)
    enter(self, instance_state::building);
  ask<image_prepared>(
      self, st.config.runtime, limits::instance::build,
      prepare_image{st.row.spec.instance, st.row.spec.operation,
                    folder->path.string(), folder->skill.hash, folder->look,
                    descriptor.entry_point, option->base_image},
      [=, chosen = *option](const image_prepared& x) {
        with_secrets(self, [=](const secrets_laid_out& secrets) {
          on_built(self, x.image, *program, chosen, secrets);
        });
      },
      [=](const caf::error& error) {
        self->state.row.log_tail =
            last_bytes(log_tail_of(error), limits::instance::log_tail_bytes);
        conclude(self, instance_state::failed, sentence(error));
      });
}

void on_place(skill_instance_pointer self, const use_environment& place) {
  auto& st = self->state;
  st.config.environment = place.environment;
  st.config.knows_place = true;
  if (!std::exchange(st.awaits_place, false))
    return;
  st.row.waits.clear();
  build(self);
}

/// The intent is on disk before anything is started: a node that is restarted
/// must know what to look for.
void begin_anew(skill_instance_pointer self) {
  self->state.started_at = self->state.config.address;
  self->state.started_in = self->state.config.boot;
  enter(self, instance_state::pending);
  ask<record_stored>(
      self, self->state.config.store, limits::instance::disk,
      record_of(self->state), [=](const record_stored&) { build(self); },
      [=](const caf::error& error) {
        conclude(self, instance_state::failed,
                 "it cannot be recorded: " + sentence(error));
      });
}

namespace {

/// A node that has started again looks for the same endpoints as before.
void recall_endpoints(skill_instance_pointer self) {
  auto& st = self->state;
  const auto folder = folder_of(st);
  if (folder == nullptr || folder->skill.descriptor.ros2.empty())
    return;
  auto start = ros2_start_of(folder->skill.descriptor, st.row.spec);
  if (const auto* x = std::get_if<ros2_start>(&start))
    st.endpoints = x->endpoints;
}

void resume(skill_instance_pointer self, const std::string& container) {
  auto& st = self->state;
  ++st.phase;
  st.row.container = container;
  st.works_with_spec = false;
  recall_endpoints(self);
  switch (st.row.state) {
  case instance_state::running:
    st.ready_since = self->clock().now();
    record_event(self, events::instance_adopted);
    report(self);
    expect_life(self);
    resume_leaving(self);
    pass_on_when_ready(self);
    return renew(self);
  case instance_state::stopping:
    st.farewell = st.row.reason;
    return take_down(self, instance_state::stopped, st.row.reason);
  default:
    // Its READY=1 comes again with its next sign of life.
    st.row.state = instance_state::starting;
    record_event(self, events::instance_adopted);
    report(self);
    expect_ready(self);
    return renew(self);
  }
}

void on_found_ended(skill_instance_pointer self, const container_adopted& x) {
  auto& st = self->state;
  st.row.exit_code = x.exit_code;
  st.row.out_of_memory = x.cause == end_cause::memory;
  if (st.row.state == instance_state::backing_off)
    return resume_pause(self);
  if (st.row.state == instance_state::stopping
      || st.row.unsafe_since_unix_ms > 0)
    st.farewell = st.row.reason;
  if (st.row.state == instance_state::stopping)
    conclude(self, instance_state::stopped, st.row.reason);
  else if (const auto* why = interruption_of(st, x))
    interrupt(self, why);
  else if (st.row.state == instance_state::running && x.exit_code == 0)
    conclude(self, instance_state::stopped, "finished");
  else
    conclude(self, instance_state::failed,
             end_reason_text(st.row, x.cause, x.most_memory_mib)
                 + " while the node was away");
}

void on_adopted(skill_instance_pointer self, const container_adopted& x) {
  self->state.adopting = false;
  const auto& row = self->state.row;
  const bool was_started = !x.container.empty() || !row.container.empty()
                           || row.state >= instance_state::running;
  if (x.running)
    resume(self, x.container);
  else if (was_started || is_of_other_boot(self->state))
    on_found_ended(self, x);
  else
    begin_anew(self);
}

} // namespace

void adopt(skill_instance_pointer self) {
  auto& st = self->state;
  ask<container_adopted>(
      self, st.config.runtime, limits::instance::start,
      adopt_container{st.row.spec.instance, st.row.container},
      [=](const container_adopted& x) { on_adopted(self, x); },
      [=](const caf::error& error) {
        take_down(self, instance_state::failed,
                  "it cannot be adopted: " + sentence(error));
      });
}

} // namespace roscell
