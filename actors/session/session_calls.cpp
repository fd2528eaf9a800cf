#include "actors/session/session_calls.hpp"

#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

caf::expected<json> result_of(const session_envelope& reply) {
  if (reply.refused)
    return fail(error_code::internal,
                "the peer's answer makes no sense: " + reply.refused->message);
  if (reply.body.value("type", "") == "error")
    return to_error(failure_from(reply.body));
  return reply.body;
}

} // namespace

std::optional<std::string>
session_calls::begin(const json& body, time_point deadline, on_result done) {
  if (calls_.size() >= limits::session::pending_calls) {
    done(fail(error_code::conflict, "too many requests wait for the peer"));
    return std::nullopt;
  }
  auto text = write_envelope(envelope_kind::request, last_id_ + 1, body);
  if (text.size() > limits::session::frame_bytes) {
    done(fail(error_code::conflict, "the request is too large for a session"));
    return std::nullopt;
  }
  calls_.emplace(++last_id_, call{deadline, std::move(done)});
  return text;
}

bool session_calls::finish(const session_envelope& reply) {
  auto which = calls_.find(reply.id);
  if (which == calls_.end())
    return false;
  settle(which, result_of(reply));
  return true;
}

void session_calls::expire(time_point now) {
  std::vector<uint64_t> overdue;
  for (const auto& [id, x] : calls_)
    if (x.deadline <= now)
      overdue.push_back(id);
  // What is done about one may have ended others.
  for (auto id : overdue)
    if (auto which = calls_.find(id); which != calls_.end())
      settle(which, fail(error_code::timeout, "the peer has not answered in "
                                              "time"));
}

void session_calls::fail_all(const std::string& reason) {
  auto all = std::exchange(calls_, {});
  for (auto& [id, x] : all)
    x.done(fail(error_code::unreachable, reason));
}

session_calls::time_point session_calls::next_deadline() const {
  auto result = time_point::max();
  for (const auto& [id, x] : calls_)
    result = std::min(result, x.deadline);
  return result;
}

void session_calls::settle(call_map::iterator which,
                           caf::expected<json> result) {
  // The callback may begin or end other calls.
  auto done = std::move(which->second.done);
  calls_.erase(which);
  done(std::move(result));
}

} // namespace roscell
