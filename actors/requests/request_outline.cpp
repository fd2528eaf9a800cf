#include "actors/requests/request_outline.hpp"

#include "messages/exec.hpp"
#include "schemas/document.hpp"

#include <variant>

namespace roscell {

namespace {

std::string text_at(const json& document, const char* name) {
  const auto i = document.find(name);
  return i != document.end() && i->is_string() ? i->get<std::string>()
                                               : std::string{};
}

} // namespace

request_outline outline_of(const json& document) {
  if (!document.is_object())
    return {};
  request_outline result{text_at(document, "type"), {}};
  for (const auto* name : {"task", "node", "instance", "cell", "name"})
    if (result.subject = text_at(document, name); !result.subject.empty())
      break;
  return result;
}

request_outline outline_of(const std::string& text) {
  auto parsed = parse_document(text);
  const auto* document = std::get_if<json>(&parsed);
  return document == nullptr ? request_outline{} : outline_of(*document);
}

bool is_query(std::string_view type) {
  constexpr std::string_view ending = "_query";
  return type.size() >= ending.size()
         && type.substr(type.size() - ending.size()) == ending;
}

bool is_remarkable(std::string_view type) {
  return !type.empty() && !is_query(type) && type != exec_input::type;
}

} // namespace roscell
