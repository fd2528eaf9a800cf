#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string_view>
#include <variant>

/// What the fuzz targets of the vocabulary have in common.
namespace roscell::fuzz {

/// Ends the run with a finding.
[[noreturn]] inline void found(std::string_view what, const json& document) {
  std::cerr << what << ": " << document << std::endl;
  std::abort();
}

/// A refusal must itself be a message that every peer takes.
inline void check_refusal(const failure& why) {
  const auto reply = error_reply(why);
  const auto text = reply.dump();
  if (validate_message(reply, {message_kind::reply}))
    found("a refusal is no valid error", reply);
  // A short document must not be answered by a long one, bounded as it is.
  if (text.size() > 200'000)
    found("a refusal is too long", text.size());
}

/// The document in `bytes`, if it is one.
inline std::optional<json> parse(const uint8_t* bytes, size_t size) {
  auto parsed =
      parse_document({reinterpret_cast<const char*>(bytes), size}, {});
  if (auto why = std::get_if<failure>(&parsed)) {
    check_refusal(*why);
    return std::nullopt;
  }
  return std::move(std::get<json>(parsed));
}

/// A document that its schema let through must be read into the struct, and
/// what the struct holds must survive the way out and in again.
template <class T>
T check_decoding(const json& document) {
  auto decoded = decode<T>(document);
  if (std::holds_alternative<failure>(decoded))
    found(std::get<failure>(decoded).message, document);
  const auto& message = std::get<T>(decoded);
  json again = message;
  if constexpr (has_message_type<T>::value)
    again["type"] = T::type;
  auto repeated = decode<T>(again);
  if (!std::holds_alternative<T>(repeated) || std::get<T>(repeated) != message)
    found("a message changes on its way", document);
  return message;
}

} // namespace roscell::fuzz
