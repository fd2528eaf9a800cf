#include "test/actors/fakes/supervision_fakes.hpp"

#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <cstdlib>
#include <fstream>
#include <utility>

namespace roscell::test {

namespace fs = std::filesystem;

std::string echo_descriptor() {
  return R"({
    "operation": "echo", "engine": "primitive", "entry_point": ["bin/echo"],
    "input": { "data_types": ["text/plain"], "protocols": ["file"] },
    "output": { "data_types": ["text/plain"], "protocols": ["file"] },
    "models": [ { "name": "plain", "deployments": [ {
      "name": "cpu", "base_image": "debian:bookworm-slim",
      "architectures": ["amd64", "arm64"],
      "environment": { "OF_DEPLOYMENT": "yes" },
      "resources": { "cpu": 0.1, "memory_mib": 16, "disk_mib": 5 } } ] } ] })";
}

echo_catalogue::echo_catalogue() {
  folder.write("echo/skill.json", echo_descriptor());
  folder.write("echo/bin/echo", "#!/bin/sh\n", true);
  skills = std::make_shared<const skill_catalogue>(
      skill_catalogue::scan({folder.path()}));
  REQUIRE(skills->skills().size() == 1);
  hash = skills->skills()[0].hash;
}

instance_spec echo_spec(const std::string& hash, const std::string& instance,
                        const std::string& task) {
  instance_spec spec;
  spec.instance = instance;
  spec.task = task;
  spec.step = "s";
  spec.operation = "echo";
  spec.model = "plain";
  spec.deployment = "cpu";
  spec.skill = hash;
  spec.cell = "kitchen";
  spec.input = {{"file", "/in.txt", "text/plain"}};
  spec.output = {{"file", "/out.txt", "text/plain"}};
  // What is started again is a rule of its own.
  spec.life.restart.policy = restart_when::never;
  return spec;
}

namespace {

/// The answer, unless it is an error.
template <class T>
caf::result<T> either(const caf::error& error, T value) {
  if (error)
    return error;
  return value;
}

/// A runtime that is also told when to give the answers it has held back: a
/// promise may be kept only inside its actor.
using scripted_runtime_actor =
    runtime_actor::extend<caf::reacts_to<caf::tick_atom, uint64_t>>;

using started_promise = caf::typed_response_promise<container_started>;

void deliver(const runtime_script& script, started_promise promise) {
  if (script.start_error)
    promise.deliver(script.start_error);
  else
    promise.deliver(container_started{script.container()});
}

caf::result<container_started> start(scripted_runtime_actor::pointer self,
                                     runtime_script& script,
                                     const start_container& x) {
  script.started.push_back(x);
  auto promise = self->make_response_promise<container_started>();
  if (script.silent)
    script.unanswered.push_back(promise);
  else
    deliver(script, promise);
  return promise;
}

scripted_runtime_actor::behavior_type
scripted_runtime(scripted_runtime_actor::pointer self,
                 const std::shared_ptr<runtime_script>& script) {
  return {
      [](const state_query&) { return state_of(json::object()); },
      [=](const prepare_image& x) {
        script->prepared.push_back(x);
        script->instance = caf::actor_cast<caf::actor>(self->current_sender());
        return either(script->prepare_error, image_prepared{x.skill_dir});
      },
      [=](const start_container& x) { return start(self, *script, x); },
      [=](const stop_container& x) -> caf::result<container_stopped> {
        script->stopped.push_back(x);
        if (script->stops_never)
          return self->make_response_promise<container_stopped>();
        return either(script->stop_error, container_stopped{script->stop_code});
      },
      [=](const remove_container& x) {
        script->removed.push_back(x);
        return either(script->remove_error, container_removed{});
      },
      [=](const adopt_container& x) {
        script->adopted.push_back(x);
        script->instance = caf::actor_cast<caf::actor>(self->current_sender());
        return either(script->adopt_error, script->adoption);
      },
      [=](const hear_container& x) {
        script->heard.push_back(x);
        if (script->deaf)
          return;
        auto words = std::exchange(script->words, {});
        words.heard = true;
        caf::anon_send(
            caf::actor_cast<skill_instance_actor>(self->current_sender()),
            words);
      },
      [=](const fence_container& x) { script->fenced.push_back(x); },
      [=](const ask_for_safety& x) { script->asked_for_safety.push_back(x); },
      [=](const log_query& x) {
        script->queries.push_back(x);
        return either(script->log_error,
                      log_excerpt{x.instance, script->log, 0, true});
      },
      [=](caf::tick_atom, uint64_t) {
        for (auto& x : std::exchange(script->unanswered, {}))
          deliver(*script, x);
      },
  };
}

} // namespace

runtime_actor fake_runtime(caf::actor_system& system,
                           std::shared_ptr<runtime_script> script) {
  auto runtime = system.spawn(scripted_runtime, script);
  script->answer = [runtime] {
    caf::anon_send(runtime, caf::tick_atom_v, uint64_t{0});
  };
  return runtime;
}

std::vector<std::string>
store_script::states(const std::string& instance) const {
  std::vector<std::string> result;
  for (const auto& x : records)
    if (x.table == "instances" && x.key == instance)
      result.push_back(x.value.empty() ? "-"
                                       : json::parse(x.value).at("state"));
  return result;
}

state_store_actor fake_store(caf::actor_system& system,
                             std::shared_ptr<store_script> script) {
  return system.spawn(
      [script](state_store_actor::pointer) -> state_store_actor::behavior_type {
        return {
            [](const state_query&) { return state_of(json::object()); },
            [=](const store_record& x) {
              script->records.push_back(x);
              return either(script->error, record_stored{});
            },
            [=](const store_records& x) {
              script->records.insert(script->records.end(), x.records.begin(),
                                     x.records.end());
              return either(script->error, record_stored{});
            },
            [](caf::tick_atom, uint64_t) {
              // Nothing waits here.
            },
        };
      });
}

std::vector<std::string> reported_changes::states() const {
  std::vector<std::string> result;
  for (const auto& x : rows)
    result.push_back(to_string(x.state));
  return result;
}

container_supervisor_actor
fake_supervisor(caf::actor_system& system,
                std::shared_ptr<reported_changes> reported) {
  using handle = container_supervisor_actor;
  return system.spawn([reported](handle::pointer) -> handle::behavior_type {
    return {
        [](const state_query&) { return state_of(json::object()); },
        [](const instance_deployment&) { return instance_deployed{}; },
        [](const instance_removal&) { return instances_removed{}; },
        [](const set_parameters& x) { return parameters_set{x.instance}; },
        [](const instance_query&) { return instance_description{}; },
        [](const log_query&) { return log_excerpt{}; },
        [](const kept_logs_query&) { return kept_logs{}; },
        [](const listen_to_instances&) {},
        [](const ends_acknowledged&) {},
        [](const use_environment&) {},
        [](const contact_proven&) {},
        [](const contact_lost&) {},
        [](const container_exited&) {},
        [](const instance_notified&) {},
        [](const runtime_problem_changed&) {},
        [](const use_router&) {},
        [reported](const instance_changed& x) {
          reported->rows.push_back(x.instance);
        },
    };
  });
}

instance_listener_actor
fake_listener(caf::actor_system& system,
              std::shared_ptr<reported_changes> reported) {
  using handle = instance_listener_actor;
  return system.spawn([reported](handle::pointer) -> handle::behavior_type {
    return {[reported](const instance_changed& x) {
      reported->rows.push_back(x.instance);
    }};
  });
}

} // namespace roscell::test
