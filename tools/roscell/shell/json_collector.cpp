#include "tools/roscell/shell/json_collector.hpp"

#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/validator.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"

#include <algorithm>
#include <optional>
#include <variant>

namespace roscell::cli {

namespace {

constexpr auto request_name = "request.json";

/// With marks under the places of `text`.
std::string shown_failure(std::string_view text, const failure& why) {
  auto result = marked_errors(request_name, text, error_reply(why));
  if (result.empty())
    result = printable(why.message) + "\n";
  const bool marks_suffice = why.code == error_code::schema_violation;
  if (!why.hint.empty() && !marks_suffice)
    result += "hint: " + printable(why.hint) + "\n";
  return result;
}

/// That its type is none of a request.
std::optional<failure> wrong_type(const json& document) {
  auto only_type = json::object();
  if (document.contains("type"))
    only_type["type"] = document["type"];
  auto why = validate_request(only_type);
  return why && why->where == "/type" ? why : std::nullopt;
}

} // namespace

bool json_collector::begins(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != line.npos && line[first] == '{';
}

/// A string ends with its line at the latest, because JSON has none that goes
/// on in the next one; so a forgotten quote hides no brace.
void json_collector::add_line(std::string_view line) {
  text_ += std::string{line} + "\n";
  bool in_string = false;
  for (size_t i = 0; i < line.size() && !ended_; ++i) {
    const char x = line[i];
    if (in_string && x == '\\')
      ++i;
    else if (x == '"')
      in_string = !in_string;
    else if (!in_string && (x == '{' || x == '['))
      ++open_;
    else if (!in_string && (x == '}' || x == ']')) {
      open_ -= open_ > 0 ? 1 : 0;
      ended_ = open_ == 0;
    }
  }
}

std::string json_collector::one_line() const {
  auto result = text_;
  std::replace(result.begin(), result.end(), '\n', ' ');
  return result.substr(0, result.find_last_not_of(' ') + 1);
}

std::string json_collector::errors() const {
  const auto parsed = parse_document(text_);
  if (const auto* why = std::get_if<failure>(&parsed))
    return shown_failure(text_, *why);
  const auto& document = std::get<json>(parsed);
  if (const auto why = wrong_type(document))
    return shown_failure(text_, *why);
  const auto errors = document_errors(document.value("type", ""), document,
                                      unknown_members::refused);
  return errors.empty() ? "" : shown_failure(text_, to_failure(errors));
}

} // namespace roscell::cli
