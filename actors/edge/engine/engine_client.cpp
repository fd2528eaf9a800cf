#include "actors/edge/engine/engine_client.hpp"

#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/engine/limits.hpp"
#include "schemas/utf8.hpp"

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

http_call to_call(const std::string& socket, const std::string& prefix,
                  engine_request what) {
  http_call result;
  result.to.socket_path = socket;
  result.method = std::move(what.method);
  result.target = prefix + what.target;
  result.headers = std::move(what.headers);
  result.body = std::move(what.body);
  result.file = std::move(what.file);
  result.timeout = what.limit;
  result.endless = what.endless;
  result.max_header_bytes = limits::engine::header_bytes;
  result.max_reply_bytes = limits::engine::reply_bytes;
  return result;
}

/// Why an engine gave no reply, with the remedy.
edge_error engine_problem(const std::string& socket, const http_failure& why,
                          std::chrono::milliseconds limit,
                          const std::string& file) {
  const auto engine = "the container engine on '" + socket + "'";
  switch (why.what) {
  case http_failure::kind::no_connection:
    return no_engine(socket, why.system_error);
  case http_failure::kind::no_file:
    return {error_code::engine_failed,
            "cannot read '" + file
                + "': " + std::generic_category().message(why.system_error),
            ""};
  case http_failure::kind::timeout:
    return {error_code::timeout,
            engine + " did not answer within "
                + std::to_string(limit.count() / 1000) + " s",
            "see the engine's own log: " + engine_log_command(socket)};
  case http_failure::kind::cut_off:
    return {error_code::unreachable,
            engine + " went away: it broke the connection",
            "is it being restarted? " + engine_log_command(socket) + " tells"};
  case http_failure::kind::too_long:
    return {error_code::unreachable, engine + " gave an answer without an end",
            "see the engine's own log: " + engine_log_command(socket)};
  default:
    return {error_code::unreachable,
            engine + " gave no answer that can be read: " + why.reason,
            "is it a container engine? " + engine_log_command(socket)
                + " tells"};
  }
}

/// What is told at the end of a call. Nothing is when the node stops: whoever
/// waits is about to end too.
std::function<void(http_outcome)>
end_of_call(const std::string& socket, const engine_request& what,
            std::function<void(engine_answer)> on_end) {
  if (!on_end)
    return {};
  return [socket, limit = what.limit, file = what.file.string(),
          on_end = std::move(on_end)](http_outcome outcome) {
    const auto* why = std::get_if<http_failure>(&outcome);
    if (why == nullptr) {
      auto& reply = std::get<http_reply>(outcome);
      on_end(engine_reply{reply.status, std::move(reply.body)});
    } else if (why->what != http_failure::kind::stopped) {
      on_end(engine_problem(socket, *why, limit, file));
    }
  };
}

} // namespace

engine_client::engine_client(std::shared_ptr<io_core> core, std::string socket,
                             std::string api)
    : core_(std::move(core)), socket_(std::move(socket)),
      prefix_(api.empty() ? "" : "/v" + api) {
  // nop
}

void engine_client::request(
    engine_request what, std::function<void(engine_answer)> on_answer) const {
  auto on_end = end_of_call(socket_, what, std::move(on_answer));
  call_http(core_, to_call(socket_, prefix_, std::move(what)),
            std::move(on_end));
}

engine_stream engine_client::stream(engine_request what,
                                    engine_stream_callbacks calls) const {
  auto on_end = end_of_call(socket_, what, std::move(calls.on_end));
  return subscribe_http(
      core_, to_call(socket_, prefix_, std::move(what)),
      {std::move(calls.on_open), std::move(calls.on_bytes), std::move(on_end)});
}

namespace {

using json = nlohmann::json;

std::string message_in(const std::string& body) {
  const auto document = json::parse(body, nullptr, false);
  if (!document.is_object())
    return body;
  auto result = text_at(document, "message");
  const auto cause = text_at(document, "cause");
  if (!cause.empty() && result.find(cause) == std::string::npos)
    result += (result.empty() ? "" : ": ") + cause;
  return result;
}

/// The beginning and the end of a text that is too long: Podman's long ones
/// tell the reason last. Half of the bound is for what it is told with.
std::string shortened(const std::string& text) {
  constexpr auto kept = limits::engine::status_bytes / 4;
  return text.size() <= 2 * kept
             ? text
             : text.substr(0, kept) + " ... " + text.substr(text.size() - kept);
}

/// What helps against what an engine complains of: a part of its words, and the
/// remedy.
constexpr std::array<std::pair<const char*, const char*>, 4> remedies{{
    {"client version",
     "another version of the engine was installed while the node ran: start "
     "the node anew (systemctl restart roscell), so that they agree on one of "
     "its API"},
    {"no space left",
     "free space on the engine's disk: docker system df (podman system df)"},
    {"could not select device driver",
     "install the NVIDIA Container Toolkit on this host, then run: nvidia-ctk "
     "runtime configure --runtime=docker && systemctl restart docker"},
    {"CDI device",
     "install the NVIDIA Container Toolkit on this host, then run: nvidia-ctk "
     "cdi generate --output=/etc/cdi/nvidia.yaml"},
}};

std::string remedy_for(const std::string& message) {
  for (const auto& [complaint, remedy] : remedies)
    if (message.find(complaint) != std::string::npos)
      return remedy;
  return {};
}

/// By the socket's name, for an engine that cannot be asked.
bool is_podman(const std::string& socket) {
  return socket.find("podman") != std::string::npos;
}

/// "systemctl start docker", for the engine that this socket is of.
std::string systemctl(const std::string& verb, const std::string& socket) {
  const bool of_user = socket.rfind("/run/user/", 0) == 0;
  return "systemctl " + std::string{of_user ? "--user " : ""} + verb
         + (is_podman(socket) ? " podman.socket" : " docker");
}

edge_error not_permitted(const std::string& socket, const std::string& where) {
  return {error_code::unauthorized, "no permission to use " + where,
          is_podman(socket)
              ? "use a Podman of the node's user (systemctl --user enable "
                "--now podman.socket), or start the node as root"
              : "add the node's user to the group docker (sudo usermod -aG "
                "docker USER), or start the node as root"};
}

} // namespace

edge_error engine_refusal(const std::string& what, const engine_reply& reply) {
  auto message = valid_utf8(shortened(message_in(reply.body)));
  while (!message.empty() && (message.back() == '\n' || message.back() == '.'))
    message.pop_back();
  if (message.empty())
    message = "HTTP status " + std::to_string(reply.status);
  auto remedy = remedy_for(message);
  return {error_code::engine_failed, what + ": " + message, std::move(remedy)};
}

edge_error no_engine(const std::string& socket, int error_number) {
  const auto where = "the container engine on '" + socket + "'";
  const std::string name = is_podman(socket) ? "podman" : "docker";
  switch (error_number) {
  case ENOENT:
    return {error_code::unreachable,
            "no container engine: there is no socket '" + socket + "'",
            "start the engine (" + systemctl("start", socket)
                + "), or name its socket: --runtime " + name + ":SOCKET"};
  case EACCES:
  case EPERM:
    return not_permitted(socket, where);
  case ECONNREFUSED:
    return {error_code::unreachable,
            "nobody listens: " + where + " does not run",
            "start the engine: " + systemctl("start", socket)};
  default:
    return {error_code::unreachable,
            "cannot reach " + where + ": "
                + std::generic_category().message(error_number),
            "is the engine running? " + systemctl("status", socket)};
  }
}

std::string engine_log_command(const std::string& socket) {
  return is_podman(socket) ? "journalctl -u podman" : "journalctl -u docker";
}

} // namespace roscell
