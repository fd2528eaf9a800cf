#include "actors/instances/process/shim_program.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/edge/process/privileges.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "messages/event_kinds.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <vector>

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

namespace {

edge_error no_such_user(const std::string& name) {
  return {error_code::engine_failed, "there is no user '" + name + "' any more",
          "the node's configuration grants it: `grant`"};
}

std::string hexadecimal(capability_set x) {
  std::array<char, 24> text;
  const int size = std::snprintf(text.data(), text.size(), "%llx",
                                 static_cast<unsigned long long>(x));
  return {text.data(), static_cast<size_t>(size)};
}

/// Root without its way around permissions could do less than anybody else.
capability_set kept_by(const start_container& request, bool is_root) {
  return to_capabilities(request.capabilities)
         | (is_root ? file_capabilities() : 0);
}

std::string user_text(const user_account& x) {
  auto result = std::to_string(x.user) + ':' + std::to_string(x.group);
  for (const auto group : x.groups)
    result += ',' + std::to_string(group);
  return result;
}

} // namespace

std::optional<edge_error> add_identity(const start_container& request,
                                       program& shim) {
  auto& words = shim.arguments;
  auto user = ::geteuid();
  if (!request.user.empty()) {
    const auto account = find_account(request.user);
    if (!account)
      return no_such_user(request.user);
    if (account->user != user)
      words.insert(words.begin(), {"--user", user_text(*account)});
    user = account->user;
    // What the step says counts more.
    if (request.environment.count("HOME") == 0)
      shim.environment["HOME"] = account->home;
    shim.environment.emplace("USER", account->name);
    shim.environment.emplace("LOGNAME", account->name);
  }
  words.insert(words.begin(),
               {"--capabilities", hexadecimal(kept_by(request, user == 0))});
  return std::nullopt;
}

std::optional<edge_error> let_in(const start_container& request,
                                 const std::filesystem::path& instance_dir) {
  if (request.user.empty())
    return std::nullopt;
  const auto account = find_account(request.user);
  if (!account)
    return no_such_user(request.user);
  if (account->user == ::geteuid() || account->user == 0)
    return std::nullopt;
  const auto socket = notify_path(instance_dir);
  std::vector<std::filesystem::path> folders{socket.parent_path()};
  if (socket.parent_path() == instance_dir)
    folders.insert(folders.end(), {instance_dir.parent_path(),
                                   instance_dir.parent_path().parent_path()});
  for (const auto& x : folders)
    if (!let_user(x, account->user, access_right::pass))
      return edge_error{error_code::engine_failed,
                        "cannot let the user '" + request.user + "' into '"
                            + x.string() + "': " + std::strerror(errno),
                        {}};
  for (const auto& x :
       {socket, environment_file_of(socket), parameter_file_of(socket)})
    if (!let_user(x, account->user, access_right::read_and_write)
        && errno != ENOENT)
      return edge_error{error_code::engine_failed,
                        "cannot give the user '" + request.user + "' '"
                            + x.string() + "': " + std::strerror(errno),
                        {}};
  return std::nullopt;
}

void drop_cgroup(const process_runtime_config& config,
                 const std::string& instance, const instance_cgroup& cgroup) {
  if (!cgroup.remove())
    config.context.publish_event(
        events::cgroup_left, instance,
        {{"folder", cgroup.folders().front().string()}});
}

instance_cgroup cgroup_of(const process_runtime_config& config,
                          const std::string& instance) {
  const auto noted = instance_cgroup::recall(config.instances_dir / instance);
  return noted.folders().empty()
             ? instance_cgroup::named(config.cgroups, instance)
             : noted;
}

instance_bounds bounds_of(const start_container& request) {
  const auto& policy = request.scheduling.policy;
  return {request.limits.memory_mib, request.limits.cpu,
          policy == "fifo" || policy == "rr"};
}

void clear_cgroups(const process_runtime_config& config) {
  std::set<std::string> known;
  std::error_code error;
  for (std::filesystem::directory_iterator i{config.instances_dir, error}, end;
       !error && i != end; i.increment(error))
    known.insert(i->path().filename().native());
  for (const auto& x : remove_other_cgroups(config.cgroups, known))
    config.context.publish_event(events::cgroup_left, x);
}

} // namespace roscell
