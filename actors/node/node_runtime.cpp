#include "actors/node/node_runtime.hpp"

#include "actors/builds/build_store.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/engine/engine_search.hpp"
#include "actors/edge/engine/registry_login.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/instances/engine/engine_runtime.hpp"
#include "actors/instances/exec/engine_exec.hpp"
#include "actors/instances/exec/process_exec.hpp"
#include "actors/instances/process/process_runtime.hpp"
#include "messages/failure.hpp"

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace {

namespace fs = std::filesystem;

fs::path shim_of(const node_config& config) {
  return config.shim.empty() ? find_shim(program_folder()) : config.shim;
}

caf::expected<chosen_runtime> choose_processes(const node_config& config,
                                               std::string why) {
  chosen_runtime result;
  result.name = "process";
  result.reason = std::move(why);
  result.shim = shim_of(config);
  if (::access(result.shim.c_str(), X_OK) != 0)
    return fail(
        error_code::engine_failed,
        "cannot run the instance shim '" + result.shim.string() + "'", "",
        "install roscell-instance-shim beside roscell, or in ../lib/roscell");
  return result;
}

/// Without a shim it runs all but what may move to another node.
chosen_runtime choose_engine(const node_config& config,
                             const found_engine& engine) {
  return {engine.name,
          engine.socket,
          engine.api,
          engine.rootless,
          shim_of(config),
          engine.name + (engine.version.empty() ? "" : " ") + engine.version
              + " answers on '" + engine.socket
              + (engine.rootless ? "', without root" : "'")};
}

fs::path kept_logs_dir(const node_config& config) {
  return config.data_dir / "history" / "logs";
}

std::function<runtime_actor(container_listener_actor)>
process_factory(caf::actor_system& system, const actor_context& context,
                const node_config& config, const chosen_runtime& chosen,
                const io_thread& io, const node_history_actor& history) {
  process_runtime_config setup;
  setup.context = context;
  setup.instances_dir = config.data_dir / "instances";
  setup.shim = chosen.shim;
  setup.log_bytes = config.log_bytes;
  setup.kept_logs = kept_logs_dir(config);
  setup.history = history;
  setup.io = io.core();
  setup.environment = basic_environment();
  setup.cgroups = chosen.cgroups;
  return [&system, context, setup](const container_listener_actor& listener) {
    return runtime_actor{
        spawn_blocking(system, context, process_runtime, setup, listener)};
  };
}

} // namespace

caf::expected<chosen_runtime> choose_runtime(const node_config& config) {
  const auto colon = config.runtime.find(':');
  const auto name = config.runtime.substr(0, colon);
  if (name == "process" && colon == std::string::npos)
    return choose_processes(config, "it was asked for");
  if (name != "auto" && name != "docker" && name != "podman")
    return fail(error_code::schema_violation,
                "there is no runtime '" + config.runtime + "'", "",
                "give auto, process, docker[:SOCKET] or podman[:SOCKET]");
  const auto engine = find_engine(
      colon == std::string::npos
          ? engine_sockets(name)
          : std::vector<std::string>{config.runtime.substr(colon + 1)});
  if (const auto* found = std::get_if<found_engine>(&engine))
    return choose_engine(config, *found);
  const auto& why = std::get<edge_error>(engine);
  if (name == "auto" && colon == std::string::npos)
    return choose_processes(config, why.message + " (" + why.hint + ")");
  return to_caf(why);
}

void find_limits(const node_config& config, const std::string& node_uuid,
                 chosen_runtime& chosen) {
  if (!chosen.socket.empty()) {
    chosen.limits = "those of " + chosen.name;
    return;
  }
  chosen.cgroups = find_cgroup_place(
      {config.cgroup, node_uuid, ::geteuid() == 0}, see_cgroups());
  chosen.limits = chosen.cgroups.text;
}

std::function<runtime_actor(container_listener_actor)>
runtime_factory(caf::actor_system& system, const actor_context& context,
                const node_config& config, const chosen_runtime& chosen,
                const std::string& node_uuid, const io_thread& io,
                const node_history_actor& history,
                const image_exchange_actor& images) {
  if (chosen.socket.empty())
    return process_factory(system, context, config, chosen, io, history);
  engine_runtime_config setup;
  setup.context = context;
  setup.socket = chosen.socket;
  setup.api = chosen.api;
  setup.images = images;
  setup.logins = find_login_places(chosen.name, config.registry_auth);
  setup.kept_images = config.skill_images;
  setup.setting = {node_uuid, config.log_bytes, chosen.name, chosen.rootless};
  setup.shim = chosen.shim;
  setup.data_dir = config.data_dir;
  setup.io = io.core();
  setup.kept_logs = kept_logs_dir(config);
  setup.history = history;
  return [&system, context, setup](const container_listener_actor& listener) {
    return runtime_actor{
        spawn_blocking(system, context, engine_runtime, setup, listener)};
  };
}

namespace {

/// Where the NOTIFY_SOCKET of an instance lies.
std::function<fs::path(const std::string&)>
socket_finder(const node_config& config, const chosen_runtime& chosen) {
  return [data_dir = config.data_dir,
          in_engine = !chosen.socket.empty()](const std::string& instance) {
    return in_engine ? container_notify_path(data_dir, instance)
                     : notify_path(data_dir / "instances" / instance);
  };
}

} // namespace

environment_writer make_environment_writer(const node_config& config,
                                           const chosen_runtime& chosen) {
  return [find = socket_finder(config, chosen)](const std::string& instance,
                                                const auto& variables) {
    return write_environment_update(environment_file_of(find(instance)),
                                    variables);
  };
}

parameter_writer make_parameter_writer(const node_config& config,
                                       const chosen_runtime& chosen) {
  return [find = socket_finder(config, chosen)](const std::string& instance,
                                                int64_t number,
                                                const std::string& text) {
    return write_parameters(parameter_file_of(find(instance)), number, text);
  };
}

request_answerer make_request_answerer(const node_config& config,
                                       const chosen_runtime& chosen) {
  return [find = socket_finder(config, chosen)](const std::string& instance,
                                                int64_t number,
                                                const std::string& problem) {
    return write_request_answer(parameter_file_of(find(instance)), number,
                                problem);
  };
}

exec_opener make_exec_opener(const node_config& config,
                             const chosen_runtime& chosen,
                             const io_thread& io) {
  if (!chosen.socket.empty())
    return engine_opener(io.core(), chosen.socket, chosen.api, config.data_dir);
  return process_opener(io.core(), chosen.shim);
}

fs::path builds_folder(const node_config& config) {
  return config.data_dir / "builds";
}

skill_places skill_places_of(const node_config& config) {
  const auto own = config.data_dir / "skills";
  // There from the first, so that what is put into it is seen. Where the disk
  // takes nothing, nobody puts anything there.
  std::error_code ignored;
  fs::create_directory(own, ignored);
  return {config.skill_dirs,
          {installed_skills(program_folder()), own,
           build_store::skills_in(builds_folder(config))}};
}

caf::expected<shared_skill_catalogue>
offered_skills(const skill_places& places, const chosen_runtime& runtime,
               const std::vector<std::string>& actor_skills) {
  const skill_host host{own_architecture(), runtime.socket.empty()};
  auto result = std::make_shared<skill_catalogue>(
      skill_catalogue::scan(places.present(), host));
  for (const auto& text : actor_skills)
    if (const auto errors = result->add_actor_skill(text); !errors.empty())
      return fail(error_code::schema_violation,
                  "the descriptor of an actor skill: " + errors[0].expected,
                  errors[0].pointer);
  return shared_skill_catalogue{std::move(result)};
}

} // namespace roscell
