#include "actors/session/session_calls.hpp"

#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/session.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

namespace roscell {

namespace {

struct envelope_word {
  envelope_kind kind;
  const char* type;
};

constexpr envelope_word words[] = {
    {envelope_kind::request, session_request::type},
    {envelope_kind::reply, session_reply::type},
    {envelope_kind::notice, session_notice::type}};

std::optional<envelope_kind> kind_of(const std::string& type) {
  for (const auto& word : words)
    if (type == word.type)
      return word.kind;
  return std::nullopt;
}

const char* type_of(envelope_kind kind) {
  return words[static_cast<size_t>(kind)].type;
}

} // namespace

std::optional<session_envelope> read_envelope(std::string_view text) {
  auto parsed = parse_document(text);
  auto* document = std::get_if<json>(&parsed);
  if (document == nullptr
      || validate_message(*document, {message_kind::session}))
    return std::nullopt;
  const auto kind = kind_of((*document)["type"].get<std::string>());
  if (!kind)
    return std::nullopt;
  session_envelope result;
  result.kind = *kind;
  result.id = document->value("id", uint64_t{0});
  result.body = std::move((*document)["body"]);
  result.refused =
      validate_message(result.body, {message_kind::session, message_kind::reply,
                                     message_kind::request});
  return result;
}

json body_of(const request_routed& answer) {
  if (answer.text.size() > limits::session::frame_bytes)
    return error_reply({error_code::conflict,
                        "the answer is too large for a session between nodes"});
  auto parsed = parse_document(answer.text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return error_reply(*why);
  return std::get<json>(std::move(parsed));
}

std::string write_envelope(envelope_kind kind, uint64_t id, json body) {
  json frame{{"type", type_of(kind)}, {"body", std::move(body)}};
  if (kind != envelope_kind::notice)
    frame["id"] = id;
  // Names and log lines may hold any bytes; the frame is always UTF-8.
  return frame.dump(-1, ' ', false, json::error_handler_t::replace);
}

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

namespace {

/// What of a spec has no narrow bound of its own.
size_t long_bytes(const instance_spec& spec) {
  auto result = spec.parameters.size();
  for (const auto& [name, value] : spec.environment)
    result += name.size() + value.size();
  for (const auto& argument : spec.arguments)
    result += argument.size();
  return result;
}

} // namespace

std::vector<instance_spec> take_long_starts(node_registered& answer) {
  std::vector<instance_spec> result;
  std::vector<instance_verdict> kept;
  size_t bytes = 0;
  for (auto& x : answer.verdicts) {
    if (!x.spec.empty())
      bytes += long_bytes(x.spec.front());
    if (x.spec.empty() || bytes <= limits::session::answered_starts_bytes)
      kept.push_back(std::move(x));
    else
      result.push_back(std::move(x.spec.front()));
  }
  answer.verdicts = std::move(kept);
  return result;
}

} // namespace roscell
