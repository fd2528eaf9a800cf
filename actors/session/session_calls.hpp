#pragma once

#include "actors/session/session_envelope.hpp"
#include "messages/failure.hpp"
#include "schemas/decode.hpp"

#include <caf/expected.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>

namespace roscell {

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

} // namespace roscell
