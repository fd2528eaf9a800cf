#include "actors/edge/session/session_frames.hpp"

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <optional>

namespace roscell {

ROSCELL_CODEC(session_hello)
ROSCELL_CODEC(session_challenge)
ROSCELL_CODEC(session_proof)
ROSCELL_CODEC(session_accepted)

namespace {

using bounds = session_frame_bounds;

template <class Frame>
std::string encode_frame(const Frame& frame) {
  return message_json(frame).dump(-1, ' ', false,
                                  json::error_handler_t::replace);
}

bool is_version(const std::string& text) {
  const auto dot = text.find('.');
  if (text.size() > bounds::version || dot == std::string::npos || dot == 0
      || dot + 1 == text.size())
    return false;
  return text.find_first_not_of("0123456789.") == std::string::npos
         && text.find('.', dot + 1) == std::string::npos;
}

bool is_hex(const std::string& text, size_t digits) {
  return text.size() == digits && from_hex(text).has_value();
}

bool is_number(int64_t value) {
  return value >= 0 && value <= bounds::number;
}

/// The name of the first field whose value is out of bounds; empty if none.
const char* broken_field(const session_hello& x) {
  if (!is_version(x.version))
    return "version";
  if (!is_name(x.node))
    return "node";
  if (!is_uuid(x.uuid))
    return "uuid";
  if (!is_number(x.epoch))
    return "epoch";
  if (!is_hex(x.nonce, bounds::nonce))
    return "nonce";
  return x.role.empty() || x.role == coordinator_role ? "" : "role";
}

const char* broken_field(const session_challenge& x) {
  if (!is_version(x.version))
    return "version";
  if (!is_name(x.node))
    return "node";
  if (!is_uuid(x.uuid))
    return "uuid";
  if (!is_name(x.cell))
    return "cell";
  if (!is_number(x.incarnation))
    return "incarnation";
  if (!is_hex(x.nonce, bounds::nonce))
    return "nonce";
  return is_hex(x.proof, bounds::proof) ? "" : "proof";
}

const char* broken_field(const session_proof& x) {
  return is_hex(x.proof, bounds::proof) ? "" : "proof";
}

const char* broken_field(const session_accepted& x) {
  return is_hex(x.session, bounds::session) ? "" : "session";
}

/// A text of a peer, made fit for a log line: bounded, without control
/// characters.
std::string tamed(const json& object, const char* key) {
  const auto i = object.find(key);
  if (i == object.end() || !i->is_string())
    return {};
  auto text = i->get<std::string>().substr(0, 1000);
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

edge_error refusal_of_peer(const json& frame) {
  const auto i = frame.find("error");
  if (i == frame.end() || !i->is_object())
    return {error_code::internal, "the peer refused without a reason", ""};
  return {error_code_from(tamed(*i, "code")), tamed(*i, "message"),
          tamed(*i, "hint")};
}

/// What a member's JSON type must be for `get` to convert nothing.
bool has_type(const json& value, const std::string&) {
  return value.is_string();
}

bool has_type(const json& value, int64_t) {
  return value.is_number_unsigned()
         && value.get<uint64_t>() <= static_cast<uint64_t>(bounds::number);
}

template <class Frame>
const char* mistyped_field(const json& frame) {
  const char* result = "";
  for_each_field<Frame>([&](const auto& f) {
    const auto i = frame.find(f.name);
    const auto fits = i == frame.end() ? f.kind == presence::optional
                                       : has_type(*i, Frame{}.*(f.member));
    if (!fits)
      result = f.name;
  });
  return result;
}

edge_error violation(const char* type, const std::string& field) {
  return {error_code::schema_violation,
          std::string{"the "} + type + " frame has no valid '" + field + "'",
          ""};
}

std::optional<edge_error> check_type(const json& frame, const char* type) {
  const auto i = frame.find("type");
  if (i != frame.end() && *i == type)
    return std::nullopt;
  if (i != frame.end() && *i == "error")
    return refusal_of_peer(frame);
  return edge_error{error_code::schema_violation,
                    std::string{"expected a frame of type "} + type, ""};
}

} // namespace

std::string encode(const session_hello& frame) {
  return encode_frame(frame);
}

std::string encode(const session_challenge& frame) {
  return encode_frame(frame);
}

std::string encode(const session_proof& frame) {
  return encode_frame(frame);
}

std::string encode(const session_accepted& frame) {
  return encode_frame(frame);
}

std::string encode(const edge_error& refusal) {
  return error_body(refusal.code, refusal.message, refusal.hint);
}

template <class Frame>
edge_result<Frame> decode_frame(std::string_view text) {
  if (text.size() > bounds::frame)
    return edge_error{error_code::malformed_json,
                      "a frame of the handshake is too large", ""};
  const auto frame = json::parse(text, nullptr, false);
  if (!frame.is_object())
    return edge_error{error_code::malformed_json,
                      "a frame of the handshake is no JSON object", ""};
  if (auto wrong = check_type(frame, Frame::type))
    return *wrong;
  if (const std::string name = mistyped_field<Frame>(frame); !name.empty())
    return violation(Frame::type, name);
  auto result = frame.get<Frame>();
  if (const std::string name = broken_field(result); !name.empty())
    return violation(Frame::type, name);
  return result;
}

template edge_result<session_hello> decode_frame(std::string_view);
template edge_result<session_challenge> decode_frame(std::string_view);
template edge_result<session_proof> decode_frame(std::string_view);
template edge_result<session_accepted> decode_frame(std::string_view);

} // namespace roscell
