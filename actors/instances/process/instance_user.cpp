#include "actors/instances/process/instance_user.hpp"

#include "actors/edge/disk/access_list.hpp"
#include "actors/edge/host/user_account.hpp"
#include "actors/edge/process/capabilities.hpp"
#include "actors/edge/process/environment_file.hpp"
#include "actors/edge/process/notify_socket.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace roscell {

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
  for (const auto& x : {socket, environment_file_of(socket)})
    if (!let_user(x, account->user, access_right::read_and_write)
        && errno != ENOENT)
      return edge_error{error_code::engine_failed,
                        "cannot give the user '" + request.user + "' '"
                            + x.string() + "': " + std::strerror(errno),
                        {}};
  return std::nullopt;
}

} // namespace roscell
