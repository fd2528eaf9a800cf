#include "tools/roscell/doctor/host/engines.hpp"

#include "tools/roscell/doctor/command_text.hpp"

#include <filesystem>
#include <set>
#include <variant>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// One that hangs is looked at: a new start would end its containers.
std::string engine_unit(const std::string& socket, bool hangs) {
  const bool podman = socket.find("podman") != std::string::npos;
  const bool of_user = socket.rfind("/run/user/", 0) == 0;
  return std::string{of_user ? "systemctl --user " : "sudo systemctl "}
         + (hangs ? "status " : "start ")
         + (podman ? "podman.socket" : "docker");
}

std::string engine_remedy(const asked_engine& engine, const edge_error& why) {
  const bool podman = engine.socket.find("podman") != std::string::npos;
  if (why.code != error_code::unauthorized)
    return engine_unit(engine.socket, why.code == error_code::timeout);
  return podman ? "systemctl --user enable --now podman.socket"
                : "sudo usermod -aG docker " + own_user();
}

finding judge_answer(const asked_engine& engine, const found_engine& found,
                     bool unified_cgroups) {
  const auto seen =
      found.name + (found.version.empty() ? "" : " " + found.version)
      + (found.rootless ? ", rootless," : "") + " answers at " + engine.socket;
  if (found.rootless && !unified_cgroups)
    return {judgement::warning,
            seen + ", and the host has cgroups of version 1",
            "a rootless engine bounds neither CPU nor memory of instances then",
            "sudo sed -i 's/^GRUB_CMDLINE_LINUX=\"/"
            "&systemd.unified_cgroup_hierarchy=1 /' /etc/default/grub && sudo "
            "update-grub   # and start the host anew"};
  return {judgement::ok, seen};
}

finding judge_silence(const std::string& runtime, const asked_engine& engine,
                      const edge_error& why) {
  const bool wanted = runtime != "auto";
  return {wanted ? judgement::broken : judgement::warning, why.message,
          wanted ? "a node with --runtime " + runtime + " does not start"
                 : "a node of this user runs skills as processes instead",
          engine_remedy(engine, why)};
}

} // namespace

std::vector<asked_engine> ask_engines(const std::string& runtime) {
  if (runtime == "process")
    return {};
  const auto colon = runtime.find(':');
  const auto sockets = colon == std::string::npos
                           ? engine_sockets(runtime)
                           : std::vector{runtime.substr(colon + 1)};
  std::vector<asked_engine> result;
  std::set<std::string> asked;
  for (const auto& socket : sockets) {
    std::error_code error;
    const auto real = fs::weakly_canonical(socket, error).string();
    if (!asked.insert(real.empty() ? socket : real).second)
      continue;
    const bool exists =
        fs::exists(socket, error) || error == std::errc::permission_denied;
    result.push_back({socket, exists, ask_for_engine(socket)});
  }
  return result;
}

findings judge_engines(const std::string& runtime,
                       const std::vector<asked_engine>& engines,
                       bool unified_cgroups) {
  if (engines.empty())
    return {{judgement::skipped, "skills are wanted as processes"}};
  findings result;
  bool one_answers = false;
  for (const auto& x : engines)
    if (const auto* found = std::get_if<found_engine>(&x.answer)) {
      result.push_back(judge_answer(x, *found, unified_cgroups));
      one_answers = true;
    }
  for (const auto& x : engines)
    if (const auto* why = std::get_if<edge_error>(&x.answer);
        why != nullptr && x.exists && !one_answers)
      result.push_back(judge_silence(runtime, x, *why));
  if (!result.empty())
    return result;
  if (runtime == "auto")
    return {{judgement::skipped,
             "there is no container engine: skills run as processes"}};
  const auto& first = engines.front();
  return {judge_silence(runtime, first, std::get<edge_error>(first.answer))};
}

findings check_engines(const checked_host& host) {
  const auto& runtime = host.config.runtime;
  std::error_code error;
  return judge_engines(
      runtime, ask_engines(runtime),
      fs::exists(host.sys + "/fs/cgroup/cgroup.controllers", error));
}

} // namespace roscell::cli
