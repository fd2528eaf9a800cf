#include "actors/requests/access/audited.hpp"

#include "messages/exec.hpp"
#include "messages/site.hpp"
#include "schemas/document.hpp"

#include <caf/send.hpp>

#include <array>
#include <string_view>

namespace roscell {

namespace {

bool is_query(std::string_view type) {
  constexpr std::string_view ending = "_query";
  return type.size() >= ending.size()
         && type.substr(type.size() - ending.size()) == ending;
}

std::string text_at(const json& document, const char* name) {
  const auto i = document.find(name);
  return i != document.end() && i->is_string() ? i->get<std::string>()
                                               : std::string{};
}

} // namespace

audited_request audited_in(const std::string& text) {
  auto parsed = parse_document(text);
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || !document->is_object())
    return {};
  audited_request result{text_at(*document, "type"), {}};
  if (is_query(result.type) || result.type == exec_input::type)
    return {};
  for (const auto* name : {"task", "node", "instance", "cell", "name"})
    if (result.subject = text_at(*document, name); !result.subject.empty())
      break;
  return result;
}

void note_outcome(const node_services& services, const audited_request& what,
                  const std::string& from, const std::string& refusal) {
  if (what.type.empty())
    return;
  if (services.audit)
    caf::anon_send(services.audit,
                   note_change{from, what.type, what.subject,
                               refusal.empty() ? "done" : refusal});
}

} // namespace roscell
