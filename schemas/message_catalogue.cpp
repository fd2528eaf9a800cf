#include "schemas/message_catalogue.hpp"

#include "messages/codec/json_codec.hpp"
#include "schemas/schema_list.hpp"
#include "schemas/text_excerpt.hpp"
#include "schemas/validator.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace roscell {

namespace {

using kind_list = std::initializer_list<message_kind>;

message_kind kind_named(std::string_view word) {
  const auto words = enum_words(message_kind{});
  auto i = std::find(words.begin(), words.end(), word);
  if (i == words.end())
    throw std::logic_error{"a schema has an unknown x-kind"};
  return static_cast<message_kind>(i - words.begin());
}

std::vector<message_type> read_types() {
  std::vector<message_type> result;
  for (const auto& schema : all_schemas())
    result.push_back({schema.name, kind_named(schema.kind), schema.reply});
  return result;
}

bool is_allowed(const message_type& type, kind_list allowed) {
  if (type.kind >= message_kind::document)
    return false;
  return allowed.size() == 0
         || std::find(allowed.begin(), allowed.end(), type.kind)
                != allowed.end();
}

std::vector<std::string_view> names_of(kind_list allowed) {
  std::vector<std::string_view> result;
  for (const auto& type : message_types())
    if (is_allowed(type, allowed))
      result.push_back(type.name);
  return result;
}

std::string hint_for(std::string_view name, kind_list allowed) {
  const auto names = names_of(allowed);
  if (auto closest = closest_word(name, names); !closest.empty())
    return "did you mean " + in_quotes(closest) + "?";
  std::string result = "known types:";
  for (auto known : names)
    result.append(" ").append(known);
  return result;
}

failure unknown(const std::string& name, kind_list allowed) {
  auto type = find_message_type(name);
  auto message = type != nullptr && type->kind < message_kind::document
                     ? in_quotes(name)
                           + " is no message for this place: its kind is "
                           + to_string(type->kind)
                     : "no message type is named " + in_quotes(name);
  return {error_code::unknown_type,
          std::move(message),
          "/type",
          hint_for(name, allowed),
          {}};
}

failure untyped(const json& message) {
  std::string expected = "expected a string that names the message type, ";
  if (!message.is_object())
    return to_failure({{"", "expected an object with a \"type\", got "
                                + shown_value(message)}});
  auto type = message.find("type");
  expected +=
      type == message.end() ? "but it is missing" : "got " + shown_value(*type);
  return to_failure({{"/type", std::move(expected)}});
}

std::string type_of(const json& message) {
  return message.at("type").get<std::string>();
}

/// None if the message has a known type of an allowed kind.
std::optional<failure> misplaced(const json& message, kind_list allowed) {
  if (!message.is_object() || !message.contains("type")
      || !message["type"].is_string())
    return untyped(message);
  const auto name = type_of(message);
  const auto* type = find_message_type(name);
  if (type == nullptr || !is_allowed(*type, allowed))
    return unknown(name, allowed);
  return std::nullopt;
}

std::optional<failure> refusal_of(const std::vector<schema_error>& errors) {
  if (errors.empty())
    return std::nullopt;
  return to_failure(errors);
}

} // namespace

const std::vector<message_type>& message_types() {
  static const auto types = read_types();
  return types;
}

const message_type* find_message_type(std::string_view name) {
  const auto& types = message_types();
  auto i = std::lower_bound(
      types.begin(), types.end(), name,
      [](const auto& type, std::string_view x) { return type.name < x; });
  return i != types.end() && i->name == name ? &*i : nullptr;
}

std::vector<schema_error> document_errors(std::string_view schema,
                                          const json& document,
                                          unknown_members others) {
  auto errors = validator::shared().validate(schema, document, others);
  const auto more = semantic_errors(schema, document);
  errors.insert(errors.end(), more.begin(), more.end());
  return errors;
}

std::optional<failure> validate_document(std::string_view schema,
                                         const json& document) {
  return refusal_of(
      document_errors(schema, document, unknown_members::refused));
}

std::optional<failure> validate_message(const json& message,
                                        kind_list allowed) {
  if (auto why = misplaced(message, allowed))
    return why;
  return refusal_of(
      document_errors(type_of(message), message, unknown_members::taken));
}

std::optional<failure> validate_request(const json& message) {
  if (auto why = misplaced(message, {message_kind::request}))
    return why;
  return validate_document(type_of(message), message);
}

} // namespace roscell
