#include "actors/session/session_envelope.hpp"

#include "actors/edge/session/limits.hpp"
#include "messages/session.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

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

} // namespace roscell
