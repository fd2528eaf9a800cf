#include "actors/node_runtime.hpp"

#include "actors/process_runtime.hpp"
#include "messages/failure.hpp"

#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace roscell {

namespace {

namespace fs = std::filesystem;

constexpr const char* shim_name = "roscell-instance-shim";

/// The shim beside this program, as it is built and as it is installed.
fs::path find_shim() {
  std::error_code problem;
  const auto program = fs::read_symlink("/proc/self/exe", problem);
  return program.parent_path() / shim_name;
}

} // namespace

caf::error check_runtime(node_config& config) {
  if (config.runtime != "auto" && config.runtime != "process")
    return fail(error_code::schema_violation,
                "this version has no runtime '" + config.runtime + "'", "",
                "give --runtime process, or leave it out");
  config.runtime = "process";
  if (config.shim.empty())
    config.shim = find_shim();
  if (::access(config.shim.c_str(), X_OK) != 0)
    return fail(error_code::engine_failed,
                "cannot run the instance shim '" + config.shim.string() + "'",
                "", "install roscell-instance-shim beside roscell");
  return caf::none;
}

std::function<runtime_actor(container_listener_actor)>
runtime_factory(caf::actor_system& system, const house& context,
                const node_config& config, const io_thread& io) {
  process_runtime_config setup;
  setup.instances_dir = config.data_dir / "instances";
  setup.shim = config.shim;
  setup.log_bytes = config.log_bytes;
  setup.io = io.core();
  setup.environment = basic_environment();
  return [&system, context, setup](const container_listener_actor& listener) {
    return runtime_actor{spawn<caf::detached>(system, context, process_runtime,
                                              setup, listener)};
  };
}

} // namespace roscell
