#include "actors/edge/engine/engine_client.hpp"

#include "actors/house/limits.hpp"
#include "schemas/utf8.hpp"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

using json = nlohmann::json;

std::string text_of(const json& document, const char* name) {
  const auto i = document.find(name);
  return i != document.end() && i->is_string() ? i->get<std::string>()
                                               : std::string{};
}

std::string words_of(const std::string& body) {
  const auto document = json::parse(body, nullptr, false);
  if (!document.is_object())
    return body;
  auto result = text_of(document, "message");
  const auto cause = text_of(document, "cause");
  if (!cause.empty() && result.find(cause) == std::string::npos)
    result += (result.empty() ? "" : ": ") + cause;
  return result;
}

http_call to_call(const std::string& socket, engine_request what) {
  http_call result;
  result.to.socket_path = socket;
  result.method = std::move(what.method);
  result.target = std::move(what.target);
  result.body = std::move(what.body);
  result.file = std::move(what.file);
  result.timeout = what.limit;
  result.endless = what.endless;
  result.max_header_bytes = limits::engine::header_bytes;
  result.max_reply_bytes = limits::engine::reply_bytes;
  return result;
}

/// Why an engine gave no reply, with the remedy.
edge_error engine_trouble(const std::string& socket, const http_failure& why,
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
            "look into the engine's own log: journalctl -u docker"};
  case http_failure::kind::cut_off:
    return {error_code::unreachable,
            engine + " went away: it broke the connection",
            "is it being restarted? journalctl -u docker tells"};
  case http_failure::kind::too_long:
    return {error_code::unreachable, engine + " gave an answer without an end",
            "look into the engine's own log: journalctl -u docker"};
  default:
    return {error_code::unreachable,
            engine + " gave no answer that can be read: " + why.reason,
            "is it a container engine? journalctl -u docker tells"};
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
      on_end(engine_trouble(socket, *why, limit, file));
    }
  };
}

} // namespace

engine_client::engine_client(std::shared_ptr<io_core> core, std::string socket)
    : core_(std::move(core)), socket_(std::move(socket)) {
  // nop
}

void engine_client::request(
    engine_request what, std::function<void(engine_answer)> on_answer) const {
  auto on_end = end_of_call(socket_, what, std::move(on_answer));
  call_http(core_, to_call(socket_, std::move(what)), std::move(on_end));
}

engine_stream engine_client::stream(engine_request what,
                                    engine_stream_callbacks calls) const {
  auto on_end = end_of_call(socket_, what, std::move(calls.on_end));
  return subscribe_http(
      core_, to_call(socket_, std::move(what)),
      {std::move(calls.on_open), std::move(calls.on_bytes), std::move(on_end)});
}

edge_error engine_refusal(const std::string& what, const engine_reply& reply) {
  auto words =
      valid_utf8(words_of(reply.body).substr(0, limits::engine::words_bytes));
  while (!words.empty() && (words.back() == '\n' || words.back() == '.'))
    words.pop_back();
  if (words.empty())
    words = "HTTP status " + std::to_string(reply.status);
  const bool full = words.find("no space left") != std::string::npos;
  return {error_code::engine_failed, what + ": " + words,
          full ? "free space on the engine's disk: docker system df" : ""};
}

edge_error no_engine(const std::string& socket, int error_number) {
  const auto where = "the container engine on '" + socket + "'";
  switch (error_number) {
  case ENOENT:
    return {error_code::unreachable,
            "no container engine: there is no socket '" + socket + "'",
            "start the engine (systemctl start docker), or name its socket: "
            "--runtime docker:SOCKET"};
  case EACCES:
  case EPERM:
    return {error_code::unauthorized, "no permission to use " + where,
            "add the node's user to the group docker (sudo usermod -aG docker "
            "USER), or start the node as root"};
  case ECONNREFUSED:
    return {error_code::unreachable,
            "nobody listens: " + where + " does not run",
            "start the engine: systemctl start docker"};
  default:
    return {error_code::unreachable,
            "cannot reach " + where + ": "
                + std::generic_category().message(error_number),
            "is the engine running? systemctl status docker"};
  }
}

} // namespace roscell
