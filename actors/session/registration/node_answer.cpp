#include "actors/session/registration/node_answer.hpp"

#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

namespace roscell {

namespace {

failure no_node(const failure& why) {
  return {error_code::unreachable,
          "what answers there is no node of ROSCell: " + why.message};
}

} // namespace

std::variant<json, failure> read_answer(const std::string& text) {
  auto parsed = parse_document(text);
  if (const auto* why = std::get_if<failure>(&parsed))
    return no_node(*why);
  auto& document = std::get<json>(parsed);
  if (const auto why = validate_message(document, {message_kind::reply}))
    return no_node(*why);
  if (document.at("type") == "error")
    return failure_from(document);
  return std::move(document);
}

} // namespace roscell
