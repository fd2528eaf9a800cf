#include "schemas/rules/schema_rule.hpp"

#include "schemas/text_excerpt.hpp"

namespace roscell {

namespace {

std::string join(const std::vector<std::string>& words, const char* last) {
  std::string result;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0)
      result += i + 1 == words.size() ? last : ", ";
    result += words[i];
  }
  return result;
}

std::string choice_of(const std::vector<std::string>& words) {
  std::vector<std::string> in_quotes;
  in_quotes.reserve(words.size());
  for (const auto& word : words)
    in_quotes.push_back('"' + word + '"');
  auto prefix = words.size() > 1 ? "one of " : "";
  return prefix + join(in_quotes, " or ");
}

std::string size_text(const schema_rule& rule, const char* part) {
  const bool high = rule.max_size != schema_rule::unlimited;
  if (!high && rule.min_size == 0)
    return "";
  auto low = std::to_string(rule.min_size);
  auto end = std::to_string(rule.max_size) + " " + part;
  if (!high)
    return " of at least " + low + " " + part;
  if (rule.min_size == 0)
    return " of at most " + end;
  return rule.min_size == rule.max_size ? " of " + end
                                        : " of " + low + " to " + end;
}

std::string string_text(const schema_rule& rule) {
  if (!rule.words.empty())
    return choice_of(rule.words);
  if (rule.pattern)
    return rule.pattern_text;
  return "a string" + size_text(rule, "characters");
}

} // namespace

std::string rule_text(const schema_rule& rule) {
  std::vector<std::string> kinds;
  for (auto choice : rule.choices)
    kinds.push_back(rule_text(*choice));
  if ((rule.kinds & kind_object) != 0)
    kinds.push_back("an object" + size_text(rule, "members"));
  if ((rule.kinds & kind_array) != 0)
    kinds.push_back("an array" + size_text(rule, "items"));
  if ((rule.kinds & kind_string) != 0)
    kinds.push_back(string_text(rule));
  if ((rule.kinds & kind_number) != 0)
    kinds.push_back("a number" + bounds_text(rule.minimum, rule.maximum));
  if ((rule.kinds & kind_integer) != 0)
    kinds.push_back("an integer" + bounds_text(rule.minimum, rule.maximum));
  if ((rule.kinds & kind_boolean) != 0)
    kinds.emplace_back("true or false");
  if ((rule.kinds & kind_null) != 0)
    kinds.emplace_back("null");
  return kinds.empty() ? "any value" : join(kinds, " or ");
}

} // namespace roscell
