#include "actors/edge/engine/engine_search.hpp"

#include "actors/edge/engine/engine_api.hpp"
#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/client/http_client.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace roscell {

namespace {

constexpr size_t max_version_bytes = 64;

/// 0, or why the socket cannot be connected to.
int try_to_connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return ENAMETOOLONG;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const unique_fd fd{
      ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!fd)
    return errno;
  return ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address),
                   sizeof address)
                 == 0
             ? 0
             : errno;
}

/// The path in "unix:///path"; empty for any other address.
std::string unix_path(const char* address) {
  constexpr std::string_view scheme = "unix://";
  const std::string_view text = address != nullptr ? address : "";
  return text.substr(0, scheme.size()) == scheme
             ? std::string{text.substr(scheme.size())}
             : std::string{};
}

/// The folder for the sockets of a user's own services. A node that no login
/// has started has no variable that tells.
std::string user_folder() {
  const char* reported = std::getenv("XDG_RUNTIME_DIR");
  return reported != nullptr && *reported != '\0'
             ? std::string{reported}
             : "/run/user/" + std::to_string(::geteuid());
}

/// The engine's reply, whatever its status.
edge_result<http_reply> ask(const std::string& socket,
                            const std::string& path) {
  http_endpoint to;
  to.socket_path = socket;
  http_client::options how;
  how.timeout = limits::engine::probe;
  auto answer = http_client{to}.request("GET", path, {}, how);
  if (auto* why = std::get_if<edge_error>(&answer))
    return edge_error{why->code,
                      "the container engine on '" + socket
                          + "' does not answer: " + why->message,
                      "see the engine's own log: "
                          + engine_log_command(socket)};
  return std::get<http_reply>(std::move(answer));
}

/// A version that Docker tells of; empty: it does not.
std::string version_in(const http_reply& reply, const char* name) {
  const auto document = nlohmann::json::parse(reply.body, nullptr, false);
  const auto version =
      document.is_object() ? document.find(name) : document.end();
  return reply.status == 200 && version != document.end()
                 && version->is_string()
             ? version->get<std::string>().substr(0, max_version_bytes)
             : std::string{};
}

/// Whose the socket is, is who the engine runs as. In a container of a rootless
/// engine that is root, as is the node then.
bool is_of_a_user(const std::string& socket) {
  struct stat info {};
  return ::stat(socket.c_str(), &info) == 0 && info.st_uid != 0;
}

} // namespace

std::vector<std::string> engine_sockets(const std::string& name) {
  std::vector<std::string> result;
  if (name != "podman") {
    if (auto path = unix_path(std::getenv("DOCKER_HOST")); !path.empty())
      result.push_back(std::move(path));
    result.emplace_back("/var/run/docker.sock");
    result.push_back(user_folder() + "/docker.sock");
  }
  if (name != "docker") {
    if (auto path = unix_path(std::getenv("CONTAINER_HOST")); !path.empty())
      result.push_back(std::move(path));
    result.push_back(user_folder() + "/podman/podman.sock");
    result.emplace_back("/run/podman/podman.sock");
  }
  return result;
}

edge_result<found_engine> ask_for_engine(const std::string& socket) {
  if (const int error = try_to_connect(socket); error != 0)
    return no_engine(socket, error);
  found_engine result{socket, "podman", {}, {}, is_of_a_user(socket)};
  auto answer = ask(socket, "/libpod/_ping");
  // Podman's version is not worth asking: it looks for the packages of all of
  // its parts, which takes a loaded host 10 s.
  if (const auto* reply = std::get_if<http_reply>(&answer);
      reply != nullptr && reply->status == 200 && reply->body == "OK")
    return result;
  if (std::holds_alternative<http_reply>(answer))
    answer = ask(socket, "/version");
  if (auto* why = std::get_if<edge_error>(&answer))
    return *why;
  result.name = "docker";
  const auto& said = std::get<http_reply>(answer);
  result.version = version_in(said, "Version");
  result.api = choose_api(version_in(said, "ApiVersion"),
                          version_in(said, "MinAPIVersion"));
  if (result.version.empty())
    return edge_error{error_code::engine_failed,
                      "no container engine answers on '" + socket + "'",
                      "name the engine's socket: --runtime docker:SOCKET"};
  return result;
}

edge_result<found_engine> find_engine(const std::vector<std::string>& sockets) {
  std::optional<edge_error> first;
  std::optional<edge_error> first_of_one_that_exists;
  for (const auto& socket : sockets) {
    auto found = ask_for_engine(socket);
    auto* why = std::get_if<edge_error>(&found);
    if (why == nullptr)
      return found;
    if (!first)
      first = *why;
    if (!first_of_one_that_exists
        && why->message.find("there is no socket") == std::string::npos)
      first_of_one_that_exists = *why;
  }
  if (first_of_one_that_exists)
    return *first_of_one_that_exists;
  return first.value_or(
      edge_error{error_code::unreachable, "no container engine was named", ""});
}

} // namespace roscell
