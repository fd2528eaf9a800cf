#include "actors/house/limits.hpp"
#include "actors/instances/instance_environment.hpp"
#include "actors/instances/instance_words.hpp"
#include "actors/instances/skill_instance_steps.hpp"

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

void on_built(skill_instance_pointer self, const std::string& image,
              const std::vector<std::string>& command,
              const deployment_option& option) {
  auto& st = self->state;
  const auto& spec = st.row.spec;
  st.row.image = image;
  enter(self, instance_state::starting);
  start_container wish;
  wish.instance = spec.instance;
  wish.image = image;
  wish.command = command;
  wish.environment = instance_environment(spec, option);
  wish.labels = {
      {"task", spec.task}, {"instance", spec.instance}, {"cell", spec.cell}};
  wish.limits = spec.resources;
  wish.gpu = spec.gpu;
  wish.input = spec.input;
  wish.output = spec.output;
  wish.devices = option.devices;
  wish.volumes = option.volumes;
  ask<container_started>(
      self, st.config.runtime, limits::instance::start, wish,
      [=](const container_started& x) { on_started(self, x.container); },
      [=](const caf::error& error) {
        take_down(self, instance_state::failed, sentence(error));
      });
}

void build(skill_instance_pointer self) {
  auto& st = self->state;
  const auto* folder = st.config.skills->find(st.row.spec.skill);
  const auto* option =
      folder != nullptr ? find_deployment(*folder, st.row.spec) : nullptr;
  if (option == nullptr)
    return conclude(self, instance_state::failed,
                    "this node does not have its skill any more");
  if (st.config.builds_images)
    enter(self, instance_state::building);
  const auto command = folder->skill.descriptor.entry_point;
  ask<image_prepared>(
      self, st.config.runtime, limits::instance::build,
      prepare_image{st.row.spec.instance, st.row.spec.operation,
                    folder->path.string(), folder->skill.hash, folder->look,
                    command, option->base_image},
      [=, chosen = *option](const image_prepared& x) {
        on_built(self, x.image, command, chosen);
      },
      [=](const caf::error& error) {
        self->state.row.log_tail =
            last_bytes(log_tail_of(error), limits::instance::log_tail_bytes);
        conclude(self, instance_state::failed, sentence(error));
      });
}

} // namespace

/// The intent is on disk before anything is started: a node that is restarted
/// must know what to look for.
void begin_anew(skill_instance_pointer self) {
  enter(self, instance_state::pending);
  ask<record_stored>(
      self, self->state.config.store, limits::instance::disk,
      record_of(self->state.row), [=](const record_stored&) { build(self); },
      [=](const caf::error& error) {
        conclude(self, instance_state::failed,
                 "it cannot be recorded: " + sentence(error));
      });
}

namespace {

void resume(skill_instance_pointer self, const std::string& container) {
  auto& st = self->state;
  ++st.phase;
  st.row.container = container;
  switch (st.row.state) {
  case instance_state::running:
    record_event(self, "instance_adopted");
    report(self);
    return limit(self, limits::instance::watchdog);
  case instance_state::stopping:
    return take_down(self, instance_state::stopped, st.row.reason);
  default:
    // Its READY=1 comes again with its next sign of life.
    st.row.state = instance_state::starting;
    record_event(self, "instance_adopted");
    report(self);
    return limit(self, limits::instance::ready);
  }
}

void on_found_ended(skill_instance_pointer self, const container_adopted& x) {
  auto& st = self->state;
  st.row.exit_code = x.exit_code;
  if (st.row.state == instance_state::stopping)
    conclude(self, instance_state::stopped, st.row.reason);
  else if (st.row.state == instance_state::running && x.exit_code == 0)
    conclude(self, instance_state::stopped, "finished");
  else
    conclude(self, instance_state::failed,
             "it ended " + exit_words(x.exit_code)
                 + " while the node was away");
}

void on_adopted(skill_instance_pointer self, const container_adopted& x) {
  const auto& row = self->state.row;
  const bool was_started = !x.container.empty() || !row.container.empty()
                           || row.state >= instance_state::running;
  if (x.running)
    resume(self, x.container);
  else if (was_started)
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
