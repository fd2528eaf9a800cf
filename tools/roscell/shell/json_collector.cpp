#include "tools/roscell/shell/json_collector.hpp"

#include "schemas/message_catalogue.hpp"
#include "schemas/reading/document_builder.hpp"
#include "schemas/reading/json_reader.hpp"
#include "schemas/validator.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

/// Looking at all that has come after each line of a long text that is pasted
/// would take longer than looking at it once.
constexpr size_t longest_looked_at = 64UL * 1024;

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

/// Whether nothing that is still to come can fix an error at `pointer`: it is
/// in none of the objects and arrays that are still open, or is a value of its
/// own there. `reading` points to what is being read.
bool is_certain(const std::string& pointer, const json& document,
                const std::string& reading) {
  json::json_pointer at{pointer};
  while (!at.empty() && !document.contains(at))
    at = at.parent_pointer();
  const auto& value = document.at(at);
  if (value.is_primitive())
    return at.to_string() == pointer;
  const auto inside = at.to_string();
  const bool may_go_on =
      reading.compare(0, inside.size(), inside) == 0
      && (reading.size() == inside.size() || reading[inside.size()] == '/');
  return !may_go_on;
}

/// What is wrong with the part of a request of a known type that has come.
std::vector<schema_error> certain_errors(const json& document,
                                         const std::string& reading) {
  const auto type = document.find("type");
  if (type == document.end())
    return {};
  auto errors = validator::shared().validate(type->get<std::string>(), document,
                                             unknown_members::refused);
  errors.erase(std::remove_if(errors.begin(), errors.end(),
                              [&](const schema_error& x) {
                                return !is_certain(x.pointer, document,
                                                   reading);
                              }),
               errors.end());
  return errors;
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

std::string json_collector::add_line(std::string_view line) {
  scan(line);
  text_ += std::string{line} + "\n";
  return ended_ || text_.size() > longest_looked_at ? "" : new_errors();
}

/// A string ends with its line at the latest, because JSON has none that goes
/// on in the next one; so a forgotten quote hides no brace.
void json_collector::scan(std::string_view line) {
  bool in_string = false;
  for (size_t i = 0; i < line.size() && !ended_; ++i) {
    const char x = line[i];
    if (in_string) {
      i += x == '\\' ? 1 : 0;
      in_string = x != '"';
    } else if (x == '"') {
      in_string = true;
      const bool begins_member =
          last_ == token::comma || last_ == token::opening;
      last_ = begins_member && !open_.empty() && open_.back() == '{'
                  ? token::name
                  : token::value;
    } else {
      scan_mark(x);
    }
  }
}

void json_collector::scan_mark(char x) {
  if (x == '{' || x == '[') {
    open_ += x;
    last_ = token::opening;
  } else if (x == '}' || x == ']') {
    if (!open_.empty())
      open_.pop_back();
    ended_ = open_.empty();
    last_ = token::value;
  } else if (x == ',') {
    last_ = token::comma;
  } else if (x == ':') {
    last_ = token::colon;
  } else if (x != ' ' && x != '\t' && x != '\r') {
    last_ = token::value;
  }
}

/// What has come as a whole document, in which every place is where it was.
std::string json_collector::closed_text() const {
  auto result = text_;
  if (last_ == token::comma)
    result += open_.back() == '{' ? "\"\":null" : "null";
  else if (last_ == token::name)
    result += ":null";
  else if (last_ == token::colon)
    result += "null";
  for (auto i = open_.rbegin(); i != open_.rend(); ++i)
    result += *i == '{' ? '}' : ']';
  return result;
}

std::string json_collector::new_errors() {
  const auto closed = closed_text();
  const auto parsed = parse_document(closed);
  if (const auto* why = std::get_if<failure>(&parsed))
    return reported_.insert("syntax").second ? shown_failure(closed, *why) : "";
  document_builder builder{{}};
  read_json(text_, builder);
  const auto& document = builder.document();
  if (const auto why = wrong_type(document); why && document.contains("type"))
    return reported_.insert("/type").second ? shown_failure(closed, *why) : "";
  auto errors = certain_errors(document, builder.where());
  errors.erase(std::remove_if(errors.begin(), errors.end(),
                              [this](const schema_error& x) {
                                return !reported_.insert(x.pointer).second;
                              }),
               errors.end());
  return errors.empty() ? "" : shown_failure(closed, to_failure(errors));
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
