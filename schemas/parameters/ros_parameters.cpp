#include "schemas/parameters/declared_parameter.hpp"

#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <regex>
#include <string_view>

namespace roscell {

namespace {

bool has_nul(const json& value) {
  return value.is_string()
         && value.get_ref<const std::string&>().find('\0') != std::string::npos;
}

bool is_too_large(const json& value) {
  return value.is_number_unsigned()
         && value.get<uint64_t>()
                > static_cast<uint64_t>(std::numeric_limits<int64_t>::max());
}

/// Numbers mix: a list of some with and some without a fraction is one of
/// numbers.
bool have_one_type(const json& list) {
  return std::all_of(list.begin(), list.end(), [&](const json& x) {
    return x.is_number() ? list.front().is_number()
                         : x.type() == list.front().type();
  });
}

std::string list_problem(const json& list, ros_reader reader) {
  if (list.empty())
    return reader == ros_reader::program
               ? "expected a list with an item, for ROS 2 cannot be given an "
                 "empty one; leave it out"
               : "";
  for (const auto& x : list) {
    if (x.is_structured() || x.is_null())
      return "expected a list of booleans, numbers or texts, which is all that "
             "ROS 2 has";
    if (auto problem = ros_problem(x, reader); !problem.empty())
      return problem;
  }
  return have_one_type(list)
             ? ""
             : "expected a list of one type, which is all that ROS 2 has";
}

bool is_word_of_yaml(std::string text) {
  constexpr std::array<std::string_view, 14> words{
      "true", "false", "yes", "no",   "on",    "off",  "y",
      "n",    "null",  "~",   ".inf", "-.inf", ".nan", "+.inf"};
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// By YAML 1.1 of launch, and by what rcl makes of it after that: "123E5" is a
/// number for it.
bool is_number_of_yaml(const std::string& text) {
  // No number is longer, and a regex takes stack for each character.
  constexpr size_t longest = 64;
  constexpr auto digits = "0123456789abcdefABCDEFxXoO_.:+-";
  static const std::regex number{
      R"([-+]?(0b[01_]+|0[xX][0-9a-fA-F_]+|0o[0-7]+|[0-9][0-9_]*(:[0-5]?[0-9])*(\.[0-9_]*)?([eE][-+]?[0-9]+)?|\.[0-9][0-9_]*([eE][-+]?[0-9]+)?))"
      R"(|[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}([Tt ].*)?)"};
  if (text.size() > longest)
    return text.find_first_not_of(digits) == std::string::npos;
  return std::regex_match(text, number);
}

/// Characters with which YAML begins something else, or ends a plain text.
bool has_marks_of_yaml(const std::string& text) {
  constexpr std::string_view begins = "-?:,[]{}#&*!|>'\"%@`=";
  const auto first = text.front();
  const bool is_sign = first == '-' && text.size() > 1 && text[1] != ' ';
  return (begins.find(first) != std::string_view::npos && !is_sign)
         || first == ' ' || text.back() == ' ' || text.back() == ':'
         || text.find(": ") != std::string::npos
         || text.find(" #") != std::string::npos
         || std::any_of(text.begin(), text.end(),
                        [](unsigned char c) { return std::iscntrl(c) != 0; });
}

bool would_be_retyped(const std::string& text) {
  return text.empty() || has_marks_of_yaml(text) || is_word_of_yaml(text)
         || is_number_of_yaml(text);
}

std::string plain_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool wants_fractions(const declared_parameter* declared) {
  if (declared == nullptr)
    return false;
  return declared->is_declared ? declared->type == "number"
                               : declared->value.is_number_float();
}

bool is_list_of_fractions(const json& list) {
  return list.is_array()
         && std::any_of(list.begin(), list.end(),
                        [](const json& x) { return x.is_number_float(); });
}

bool wants_items_with_fractions(const json& list,
                                const declared_parameter* declared) {
  if (declared != nullptr && !declared->items.empty())
    return declared->items == "number";
  return is_list_of_fractions(list)
         || (declared != nullptr && is_list_of_fractions(declared->value));
}

json with_fraction(const json& value) {
  return value.is_number_integer() ? json(value.get<double>()) : value;
}

} // namespace

std::string ros_problem(const json& value, ros_reader reader) {
  if (has_nul(value))
    return "expected a text without NUL, with which arguments of programs end";
  if (is_too_large(value))
    return "expected a number of at most 9223372036854775807, which is the "
           "largest integer of ROS 2";
  if (value.is_null())
    return "expected a value, for ROS 2 has no null; leave it out";
  if (value.is_object())
    return "expected no object, which ROS 2 cannot be given; name its members "
           "one by one, with dots between";
  return value.is_array() ? list_problem(value, reader) : "";
}

std::vector<schema_error> ros_errors(const json& values, ros_reader reader,
                                     const std::string& place) {
  std::vector<schema_error> result;
  for (const auto& [name, value] : values.items())
    if (auto problem = ros_problem(value, reader); !problem.empty())
      result.push_back({(json::json_pointer{place} / name).to_string(),
                        problem + ", got " + shown_value(value)});
  return result;
}

std::string ros_text(const json& value, const declared_parameter* declared,
                     ros_reader reader) {
  if (value.is_string() && reader == ros_reader::launch_file
      && !would_be_retyped(value.get_ref<const std::string&>()))
    return value.get<std::string>();
  if (value.is_number())
    return plain_text(wants_fractions(declared) ? with_fraction(value) : value);
  if (!value.is_array() || !wants_items_with_fractions(value, declared))
    return plain_text(value);
  json list = json::array();
  for (const auto& x : value)
    list.push_back(with_fraction(x));
  return plain_text(list);
}

} // namespace roscell
