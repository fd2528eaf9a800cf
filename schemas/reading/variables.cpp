#include "schemas/reading/variables.hpp"

#include "schemas/document.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

namespace {

constexpr const char* member = "variables";
constexpr std::string_view opening = "${";

failure wrong(std::string message, std::string where) {
  return {error_code::schema_violation, std::move(message), std::move(where),
          "", ""};
}

bool is_name(std::string_view text, const variable_limits& limits) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
           || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= limits.max_name_bytes
         && !(text[0] >= '0' && text[0] <= '9')
         && std::all_of(text.begin(), text.end(), fits);
}

const char* kind_of(const json& value) {
  if (value.is_number())
    return "a number";
  if (value.is_boolean())
    return "true or false";
  if (value.is_string())
    return "a text";
  return value.is_array() ? "a list" : "an object";
}

std::string unknown_text(std::string_view name, const json& values) {
  std::vector<std::string_view> names;
  for (const auto& [known, value] : values.items())
    names.emplace_back(known);
  return unknown_name_text("variable", name, names);
}

/// The names with their defaults, which have been checked.
std::variant<json, failure> declared_in(const json& document,
                                        const variable_limits& limits) {
  const std::string where = std::string{"/"} + member;
  const auto& declared = document.at(member);
  if (!declared.is_object() || declared.size() > limits.max_variables)
    return wrong("expected \"variables\", an object of at most "
                     + std::to_string(limits.max_variables)
                     + " names with their defaults, but it is "
                     + shown_value(declared),
                 where);
  for (const auto& [name, value] : declared.items())
    if (!is_name(name, limits))
      return wrong("a variable is named by 1 to "
                       + std::to_string(limits.max_name_bytes)
                       + " letters, digits and '_', the first no digit: "
                       + in_quotes(name) + " is no such name",
                   where);
  return declared;
}

/// What a word of a command line means where that default stands.
std::variant<json, failure> read_word(const std::string& word,
                                      const json& standard) {
  if (standard.is_string())
    return json(word);
  return parse_document(word, document_format::yaml);
}

std::optional<failure> set_value(json& values, const std::string& name,
                                 json value) {
  const auto found = values.find(name);
  if (found == values.end())
    return wrong(unknown_text(name, values), std::string{"/"} + member);
  if (!found->is_null() && std::string_view{kind_of(value)} != kind_of(*found))
    return wrong("the variable " + in_quotes(name) + " is " + kind_of(*found)
                     + ", and " + shown_value(value) + " is given",
                 std::string{"/"} + member + "/" + name);
  *found = std::move(value);
  return std::nullopt;
}

/// The value of each variable.
std::variant<json, failure> values_of(json values, const given_values& given) {
  const auto defaults = values;
  for (const auto& [name, value] : given.typed.items())
    if (given.words.count(name) == 0)
      if (auto why = set_value(values, name, value))
        return std::move(*why);
  for (const auto& [name, word] : given.words) {
    auto value = read_word(word, defaults.value(name, json{}));
    if (auto* why = std::get_if<failure>(&value))
      return wrong("the value of the variable " + in_quotes(name) + ": "
                       + why->message,
                   std::string{"/"} + member + "/" + name);
    if (auto why = set_value(values, name, std::get<json>(std::move(value))))
      return std::move(*why);
  }
  for (const auto& [name, value] : values.items())
    if (value.is_null())
      return wrong("the variable " + in_quotes(name)
                       + " has no value; give one with --set " + name
                       + "=VALUE",
                   std::string{"/"} + member + "/" + name);
  return values;
}

/// Fills in all texts of a document. After the first problem nothing more
/// happens.
class variable_filler {
public:
  variable_filler(const json& values, const variable_limits& limits)
      : values_(values), limits_(limits) {}

  void fill(json& x, const std::string& where) {
    if (problem_)
      return;
    if (x.is_string())
      return fill_text(x, where);
    if (x.is_array())
      for (size_t i = 0; i < x.size(); ++i)
        fill(x[i], where + "/" + std::to_string(i));
    if (x.is_object())
      for (const auto& [name, value] : x.items())
        fill(value, where + "/" + escaped(name));
  }

  const std::optional<failure>& problem() const {
    return problem_;
  }

private:
  /// A name in a JSON pointer (RFC 6901).
  static std::string escaped(const std::string& name) {
    std::string result;
    for (const char c : name)
      result += c == '~' ? "~0" : c == '/' ? "~1" : std::string{c};
    return result;
  }

  /// Whether a name is one that the coordinator fills in, of a set of tasks or
  /// of copies, and that the document does not use for a variable of its own.
  bool is_left(const std::string& text, size_t at) const {
    for (const auto* name : {"node", "copy"})
      if (text.compare(at, 5, std::string{name} + "}") == 0)
        return values_.find(name) == values_.end();
    return false;
  }

  /// The name that begins behind `${` at `at`, and where its text goes on.
  const json* value_at(const std::string& text, size_t at, size_t& next,
                       const std::string& where) {
    const auto end = text.find('}', at);
    const auto name = text.substr(at, end - at);
    if (end == std::string::npos || !is_name(name, limits_)) {
      problem_ = wrong("expected the name of a variable and '}' behind \"${\" "
                       "in "
                           + in_quotes(text)
                           + "; $${ stands for the two characters themselves",
                       where);
      return nullptr;
    }
    const auto found = values_.find(name);
    if (found == values_.end()) {
      problem_ = wrong(unknown_text(name, values_), where);
      return nullptr;
    }
    next = end + 1;
    return &*found;
  }

  /// Whether there is room for so much more.
  bool add(size_t bytes, const std::string& where) {
    added_ += bytes;
    if (added_ > limits_.max_added_bytes)
      problem_ = wrong("the values of the variables make more than "
                           + std::to_string(limits_.max_added_bytes)
                           + " bytes of text",
                       where);
    return !problem_;
  }

  void fill_text(json& x, const std::string& where) {
    const auto text = x.get<std::string>();
    std::string result;
    size_t at = 0;
    for (auto found = text.find(opening); found != std::string::npos;
         found = text.find(opening, at)) {
      const bool is_plain = found > at && text[found - 1] == '$';
      result.append(text, at, found - at - (is_plain ? 1 : 0));
      at = found + opening.size();
      if (is_plain || is_left(text, at)) {
        result += opening;
        continue;
      }
      const auto* value = value_at(text, at, at, where);
      if (value == nullptr)
        return;
      const auto written =
          value->is_string() ? value->get<std::string>() : value->dump();
      if (!add(written.size(), where))
        return;
      if (found == 0 && at == text.size()) {
        x = *value;
        return;
      }
      if (value->is_structured()) {
        problem_ =
            wrong("the variable in " + in_quotes(text) + " is "
                      + kind_of(*value) + ", which cannot stand within a text",
                  where);
        return;
      }
      result += written;
    }
    x = result.append(text, at);
  }

  const json& values_;
  const variable_limits& limits_;
  size_t added_ = 0;
  std::optional<failure> problem_;
};

} // namespace

std::variant<json, failure> fill_variables(json document,
                                           const given_values& given,
                                           const variable_limits& limits) {
  if (!document.is_object() || !document.contains(member)) {
    if (given.empty())
      return document;
    return wrong("values are given, and the document has no \"variables\" to "
                 "take them",
                 "");
  }
  auto declared = declared_in(document, limits);
  if (auto* why = std::get_if<failure>(&declared))
    return std::move(*why);
  const auto values = values_of(std::get<json>(std::move(declared)), given);
  if (const auto* why = std::get_if<failure>(&values))
    return *why;
  document.erase(member);
  variable_filler filler{std::get<json>(values), limits};
  filler.fill(document, "");
  if (filler.problem())
    return *filler.problem();
  return document;
}

} // namespace roscell
