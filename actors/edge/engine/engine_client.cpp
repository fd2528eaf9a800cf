#include "actors/edge/engine/engine_client.hpp"

#include "actors/edge/engine/engine_text.hpp"

#include <system_error>
#include <utility>

namespace roscell {

namespace {

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

} // namespace roscell
