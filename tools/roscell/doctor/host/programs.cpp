#include "tools/roscell/doctor/host/programs.hpp"

#include "actors/core/program_version.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/instances/skills/skill_catalogue.hpp"
#include "actors/node/node_runtime.hpp"
#include "tools/roscell/doctor/command_text.hpp"

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastrtps/config.h>

#include <dlfcn.h>

#include <filesystem>
#include <set>
#include <variant>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// The library whose code makes participants, by its real name.
std::string loaded_fast_dds() {
  Dl_info where{};
  const auto* code = reinterpret_cast<const void*>(
      &eprosima::fastdds::dds::DomainParticipantFactory::get_instance);
  if (dladdr(code, &where) == 0 || where.dli_fname == nullptr)
    return {};
  // The address may be that of this program's own way to the library.
  std::error_code error;
  return fs::canonical(where.dli_fname, error).string();
}

} // namespace

finding judge_versions(const std::string& built, const std::string& loaded) {
  const auto seen = std::string{"roscell "} + program_version + ", Fast DDS "
                    + built + (loaded.empty() ? "" : " (" + loaded + ")");
  const auto file = fs::path{loaded}.filename().string();
  const auto number = file.find(".so.");
  if (number == file.npos || file.substr(number + 4) == built)
    return {judgement::ok, seen};
  return {
      judgement::warning, seen,
      "roscell was built with another version of Fast DDS than it runs with",
      "dpkg -S " + shell_word(loaded)};
}

findings judge_skills(size_t good, const std::vector<skill_problem>& problems) {
  findings result;
  for (const auto& x : problems) {
    auto folder = fs::path{x.path};
    if (folder.has_extension())
      folder = folder.parent_path();
    result.push_back({judgement::broken, x.path + ": " + x.message,
                      "a node leaves the skill out, and steps that need it are "
                      "not placed here",
                      "roscell skill check " + shell_word(folder.string())});
  }
  if (problems.empty())
    result.push_back({good == 0 ? judgement::skipped : judgement::ok,
                      good == 0 ? "this host has no skills"
                                : std::to_string(good) + " can be loaded"});
  return result;
}

findings check_versions(const checked_host& /*host*/) {
  return {judge_versions(FASTRTPS_VERSION_STR, loaded_fast_dds())};
}

findings check_skills(const checked_host& host) {
  auto dirs = host.config.skill_dirs;
  dirs.push_back(installed_skills(program_folder()));
  dirs.push_back(host.config.data_dir / "skills");
  std::vector<fs::path> there;
  std::error_code error;
  for (const auto& x : dirs)
    if (fs::is_directory(x, error))
      there.push_back(x);
  const auto runtime = choose_runtime(host.config);
  const auto found = skill_catalogue::scan(
      there, {own_architecture(), runtime && runtime->socket.empty()});
  return judge_skills(found.skills().size(), found.problems());
}

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
