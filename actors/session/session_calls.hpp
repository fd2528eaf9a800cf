#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "messages/inside/requests.hpp"
#include "messages/session.hpp"
#include "schemas/document.hpp"

#include <caf/expected.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The frames that pass between a member and its coordinator, as text.
namespace roscell {

enum class envelope_kind { request, reply, notice };

/// A frame that came in. Its body has passed its schema unless `refused`.
struct session_envelope {
  envelope_kind kind = envelope_kind::notice;
  uint64_t id = 0; ///< Of a request or reply.
  json body;
  std::optional<failure> refused; ///< What is wrong with the body.
};

/// Reads one frame. Nothing when not even the envelope can be read, and so
/// nobody can be told.
std::optional<session_envelope> read_envelope(std::string_view text);

/// The body of a frame that answers what the request router has answered, or
/// says that it is too large for one.
json body_of(const request_routed& answer);

/// The text of a frame. `id` is of no interest to a notice.
std::string write_envelope(envelope_kind kind, uint64_t id, json body);

/// The requests that one side of a session has sent and that wait for their
/// replies. Pure: told the time, and it hands out the frames to send.
class session_calls {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Called exactly once for each call. An error reply comes as the error that
  /// it tells of.
  using on_result = std::function<void(caf::expected<json>)>;

  /// The frame of a new request. Where there is none, `done` has been called
  /// with the error: conflict (too many calls wait, or it is too large).
  std::optional<std::string> begin(const json& body, time_point deadline,
                                   on_result done);

  /// Gives a reply to its call. False if no call has that id: it has been
  /// answered or given up already, or never was.
  bool finish(const session_envelope& reply);

  /// Gives up the calls whose time is over. Error: timeout.
  void expire(time_point now);

  /// Gives up all calls. Error: unreachable.
  void fail_all(const std::string& reason);

  /// When the next call is to be given up; time_point::max() when none waits.
  time_point next_deadline() const;

  size_t pending() const {
    return calls_.size();
  }

private:
  struct call {
    time_point deadline;
    on_result done;
  };

  using call_map = std::map<uint64_t, call>;

  void settle(call_map::iterator which, caf::expected<json> result);

  uint64_t last_id_ = 0;
  call_map calls_;
};

/// A reply as the struct that it should be. Error: internal (the peer answered
/// with something else).
template <class Reply>
caf::expected<Reply> reply_as(const json& body) {
  auto decoded = decode<Reply>(body);
  if (auto* reply = std::get_if<Reply>(&decoded))
    return std::move(*reply);
  return fail(error_code::internal, "the peer's answer makes no sense: "
                                        + std::get<failure>(decoded).message);
}

/// Takes the starts out of an answer to a registration for which one frame has
/// no room: parameters may be long. They follow it as requests of their own.
std::vector<instance_spec> take_long_starts(node_registered& answer);

} // namespace roscell
