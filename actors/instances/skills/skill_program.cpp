#include "actors/instances/skills/skill_program.hpp"

#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/engine/program_libraries.hpp"
#include "actors/edge/host/host_probe.hpp"
#include "actors/edge/process/elf_properties.hpp"
#include "actors/instances/skills/skill_descriptor_file.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

edge_error failed(const std::string& what, const fs::path& path,
                  const std::string& why, std::string hint) {
  return {error_code::engine_failed, what + " '" + path.string() + "': " + why,
          std::move(hint)};
}

} // namespace

edge_result<fs::path>
find_program(const fs::path& skill_dir,
             const std::vector<std::string>& entry_point) {
  const auto descriptor = descriptor_of(skill_dir).string();
  if (entry_point.empty())
    return failed("the skill in", skill_dir, "names no program",
                  "write \"entry_point\" into " + descriptor);
  const auto path = skill_dir / entry_point[0];
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return failed("the skill's program is missing:", path,
                  error ? error.message() : "it is no file",
                  "build the skill, or correct \"entry_point\" in "
                      + descriptor);
  if (::access(path.c_str(), X_OK) != 0)
    return failed("the skill's program cannot be run:", path,
                  std::strerror(errno), "chmod +x " + path.string());
  return path;
}

namespace {

/// Whether a deployment brings folders of libraries of its own.
bool has_own_libraries(const std::vector<implementation_model>& models) {
  for (const auto& model : models)
    for (const auto& x : model.deployments)
      if (x.environment.count("LD_LIBRARY_PATH") > 0)
        return true;
  return false;
}

/// The architectures of all deployments; sorted.
std::set<std::string>
deployed_on(const std::vector<implementation_model>& models) {
  std::set<std::string> result;
  for (const auto& model : models)
    for (const auto& x : model.deployments)
      result.insert(x.architectures.begin(), x.architectures.end());
  return result;
}

template <class Words>
std::string in_words(const Words& words) {
  std::string result;
  for (const auto& x : words)
    result += (result.empty() ? "" : ", ") + x;
  return result;
}

/// The program that the system starts for a script; empty for anything else.
std::string interpreter_of_script(const fs::path& program) {
  constexpr size_t max_line_bytes = 256; // The kernel reads no more either.
  std::ifstream file{program, std::ios::binary};
  std::string line(max_line_bytes, '\0');
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<size_t>(file.gcount()));
  if (line.rfind("#!", 0) != 0)
    return {};
  const auto first = line.find_first_not_of(" \t", 2);
  const auto end = line.find_first_of(" \t\n", first);
  return first == std::string::npos ? "" : line.substr(first, end - first);
}

/// Why what starts a program keeps it from running, if it does.
std::optional<edge_error>
interpreter_problem(const fs::path& program, const elf_properties& properties) {
  auto interpreter = properties.interpreter;
  if (interpreter.empty())
    interpreter = interpreter_of_script(program);
  if (interpreter.empty() || ::access(interpreter.c_str(), X_OK) == 0)
    return std::nullopt;
  return failed("the skill's program cannot be run:", program,
                "this node does not have '" + interpreter
                    + "', which starts it",
                "install what it belongs to");
}

/// Why the libraries of a program keep it from running, if they do.
std::optional<edge_error> library_problem(const fs::path& program,
                                          bool needs_c_library) {
  auto missing = missing_libraries(program);
  if (const auto* why = std::get_if<edge_error>(&missing)) {
    // A host that is too busy to say so says nothing about the program.
    if (why->code == error_code::timeout)
      return std::nullopt;
    return failed("the skill's program cannot be loaded:", program,
                  why->message, "build the skill on this host");
  }
  auto& names = std::get<std::vector<std::string>>(missing);
  if (!needs_c_library)
    names.erase(std::remove_if(names.begin(), names.end(), is_c_library),
                names.end());
  if (names.empty())
    return std::nullopt;
  return failed("the skill's program lacks shared libraries:", program,
                "this node does not have " + in_words(names),
                "install the packages that have them, or build the skill on "
                "this host: apt-file search "
                    + names.front().substr(0, names.front().find(' ')));
}

} // namespace

checked_program check_program(const fs::path& skill_dir,
                              const std::vector<std::string>& entry_point,
                              const std::vector<implementation_model>& models,
                              const skill_host& host) {
  checked_program result;
  auto program = find_program(skill_dir, entry_point);
  if (auto* why = std::get_if<edge_error>(&program)) {
    result.problems.push_back(std::move(*why));
    return result;
  }
  const auto& path = std::get<fs::path>(program);
  const auto properties = read_elf(path).value_or(elf_properties{});
  result.made_for = properties.architecture;
  const auto deployed = deployed_on(models);
  if (!runs_on(result.made_for, host.architecture))
    result.problems.push_back({error_code::engine_failed,
                               "is built for " + result.made_for
                                   + ", and this node is " + host.architecture,
                               ""});
  if (!deployed.empty()
      && std::none_of(deployed.begin(), deployed.end(), [&](const auto& x) {
           return runs_on(result.made_for, x);
         }))
    result.problems.push_back({error_code::engine_failed,
                               "is built for " + result.made_for
                                   + ", and its deployments are for "
                                   + in_words(deployed),
                               ""});
  // Of another host nobody here knows what it has.
  if (!result.problems.empty() || host.architecture != own_architecture())
    return result;
  if (host.runs_processes)
    if (auto why = interpreter_problem(path, properties))
      result.problems.push_back(std::move(*why));
  if (!has_own_libraries(models))
    if (auto why = library_problem(path, host.runs_processes))
      result.problems.push_back(std::move(*why));
  return result;
}

bool runs_on(const std::string& architecture, const std::string& host) {
  return architecture.empty() || architecture == host
         || (architecture == "386" && host == "amd64")
         || (architecture == "arm" && host == "arm64");
}

std::string own_architecture() {
  utsname system{};
  return ::uname(&system) == 0 ? architecture_of(system.machine)
                               : std::string{};
}

edge_result<bool> check_build(const prepare_image& request) {
  const auto look = read_folder(request.skill_dir);
  if (const auto* now = std::get_if<folder_fingerprint>(&look);
      now != nullptr && now->state == request.look)
    return true;
  auto hash = hash_folder(request.skill_dir);
  if (auto* why = std::get_if<edge_error>(&hash))
    return std::move(*why);
  if (std::get<std::string>(hash) == request.skill)
    return true;
  return edge_error{error_code::engine_failed,
                    "the skill folder '" + request.skill_dir
                        + "' was edited after this node had read it: it is not "
                          "build "
                        + request.skill.substr(0, 12) + " any more",
                    "what is there now is a build of its own: run the task "
                    "again, once `roscell skills` shows it"};
}

} // namespace roscell
