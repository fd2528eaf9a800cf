#include "actors/instances/process/shim_program.hpp"

#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/instances/life/instance_text.hpp"

#include <string>

namespace roscell {

namespace fs = std::filesystem;

program shim_for(const process_runtime_config& config, const fs::path& dir,
                 const start_container& request,
                 const instance_cgroup& cgroup) {
  program result;
  result.path = config.shim;
  result.arguments = {"--dir",         dir.string(),
                      "--log-bytes",   std::to_string(config.log_bytes),
                      "--cwd",         request.image,
                      "--stop-signal", std::to_string(request.stop_signal)};
  auto& words = result.arguments;
  if (request.fence_boot_ms != 0)
    words.insert(words.end(), {"--fence", fence_path(dir).string()});
  for (const auto& folder : cgroup.folders())
    words.insert(words.end(), {"--cgroup", folder.string()});
  if (const auto word = scheduling_word(request.scheduling); !word.empty())
    words.insert(words.end(), {"--scheduling", word});
  words.insert(
      words.end(),
      {"--", (fs::path{request.image} / request.command.at(0)).string()});
  words.insert(words.end(), request.command.begin() + 1, request.command.end());
  result.environment = request.environment;
  result.environment["NOTIFY_SOCKET"] = notify_path(dir).string();
  result.environment[folder_variable] = dir.string();
  // Does not replace what was given.
  result.environment.insert(config.environment.begin(),
                            config.environment.end());
  return result;
}

} // namespace roscell
