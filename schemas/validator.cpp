#include "schemas/validator.hpp"

#include "messages/codec/json_codec.hpp"
#include "schemas/rules/schema_rule.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// The kinds that a value is of: an integer is a number, too.
uint8_t kinds_of(const json& x) {
  switch (x.type()) {
  case json::value_t::null:
    return kind_null;
  case json::value_t::boolean:
    return kind_boolean;
  case json::value_t::number_integer:
  case json::value_t::number_unsigned:
    return kind_integer | kind_number;
  case json::value_t::number_float: {
    auto value = x.get<double>();
    // Draft 7: a number without a fraction is an integer, even as 1.0.
    auto integer = value == std::trunc(value) ? kind_integer : 0;
    return static_cast<uint8_t>(kind_number | integer);
  }
  case json::value_t::string:
    return kind_string;
  case json::value_t::array:
    return kind_array;
  case json::value_t::object:
    return kind_object;
  default:
    return 0;
  }
}

bool allows_kind(const schema_rule& rule, const json& x) {
  return rule.kinds == 0 || (rule.kinds & kinds_of(x)) != 0;
}

bool allows_size(const schema_rule& rule, size_t size) {
  return size >= rule.min_size && size <= rule.max_size;
}

bool allows_string(const schema_rule& rule, const std::string& text) {
  if (!rule.words.empty())
    return std::find(rule.words.begin(), rule.words.end(), text)
           != rule.words.end();
  return allows_size(rule, character_count(text))
         && (!rule.pattern || rule.pattern->matches(text));
}

/// Whether the value itself is allowed, whatever is inside it.
bool allows(const schema_rule& rule, const json& x) {
  if (!allows_kind(rule, x))
    return false;
  if (x.is_string())
    return allows_string(rule, x.get_ref<const std::string&>());
  if (x.is_structured())
    return allows_size(rule, x.size());
  if (x.is_number()) {
    auto value = x.get<double>();
    return value >= rule.minimum && value <= rule.maximum;
  }
  return true;
}

/// One walk over a document. Its depth is that of the schema, which is not
/// recursive.
class walk {
public:
  explicit walk(unknown_members others) : others_(others) {
    // nop
  }

  std::vector<schema_error> errors;

  void visit(const schema_rule& rule, const json& x) {
    if (errors.size() >= validator::max_errors)
      return;
    if (!rule.choices.empty())
      visit_choice(rule, x);
    else if (!allows(rule, x))
      refuse(rule, "got " + shown_value(x));
    else if (x.is_object())
      visit_members(rule, x);
    else if (x.is_array() && rule.items != nullptr)
      visit_items(*rule.items, x);
  }

private:
  void refuse(const schema_rule& rule, const std::string& finding) {
    errors.push_back(
        {here_.to_string(), "expected " + rule_text(rule) + ", " + finding});
  }

  void visit_choice(const schema_rule& rule, const json& x) {
    for (auto choice : rule.choices)
      if (allows_kind(*choice, x))
        return visit(*choice, x);
    refuse(rule, "got " + shown_value(x));
  }

  void visit_items(const schema_rule& rule, const json& x) {
    for (size_t i = 0; i < x.size(); ++i)
      step_into(std::to_string(i), rule, x[i]);
  }

  void visit_members(const schema_rule& rule, const json& x) {
    for (const auto& [name, member, required] : rule.members) {
      auto i = x.find(name);
      if (i != x.end())
        step_into(name, *member, *i);
      else if (required)
        refuse_absence(name, *member);
    }
    if (rule.member_names != nullptr)
      visit_names(*rule.member_names, x);
    if (rule.other_members != nullptr)
      visit_others(rule, x);
    else if (others_ == unknown_members::refused && !rule.members.empty())
      refuse_others(rule, x);
  }

  void refuse_absence(const std::string& name, const schema_rule& rule) {
    errors.push_back(
        {(here_ / name).to_string(), absence_text(name, rule_text(rule))});
  }

  void visit_names(const schema_rule& rule, const json& x) {
    for (const auto& [name, value] : x.items())
      if (!allows(rule, name))
        step_into(name, rule, name);
  }

  void visit_others(const schema_rule& rule, const json& x) {
    for (const auto& [name, value] : x.items())
      if (rule.find_member(name) == nullptr)
        step_into(name, *rule.other_members, value);
  }

  void refuse_others(const schema_rule& rule, const json& x) {
    for (const auto& [name, value] : x.items()) {
      if (errors.size() >= validator::max_errors)
        return;
      if (rule.find_member(name) == nullptr)
        errors.push_back(
            {(here_ / name).to_string(), unknown_member_text(rule, name)});
    }
  }

  void step_into(const std::string& name, const schema_rule& rule,
                 const json& x) {
    here_.push_back(name);
    visit(rule, x);
    here_.pop_back();
  }

  unknown_members others_;
  json::json_pointer here_;
};

} // namespace

std::vector<schema_error> validate(const schema_rule& rule,
                                   const json& document,
                                   unknown_members others) {
  walk result{others};
  result.visit(rule, document);
  return std::move(result.errors);
}

struct validator::state {
  std::mutex mutex; ///< Guards `reader`; what it has read never changes.
  schema_reader reader;
};

validator::validator() : state_(std::make_unique<state>()) {
  // nop
}

validator::~validator() = default;

const validator& validator::shared() {
  static const validator instance;
  return instance;
}

std::vector<schema_error> validator::validate(std::string_view schema,
                                              const json& document,
                                              unknown_members others) const {
  const schema_rule* rule = nullptr;
  {
    std::lock_guard guard{state_->mutex};
    rule = &state_->reader.rule(std::string{schema});
  }
  return roscell::validate(*rule, document, others);
}

namespace {

constexpr size_t max_listed = 50;

std::string summary(const std::vector<schema_error>& errors) {
  const auto& first = errors.front();
  auto place = first.pointer.empty() ? "the document" : first.pointer;
  auto result = place + ": " + first.expected;
  if (auto others = errors.size() - 1; others > 0)
    result += " (and " + std::to_string(others)
              + (others == 1 ? " more error)" : " more errors)");
  return result;
}

} // namespace

failure to_failure(const std::vector<schema_error>& errors) {
  json list = json::array();
  const auto listed = std::min(errors.size(), max_listed);
  for (size_t i = 0; i < listed; ++i)
    list.push_back(
        {{"where", errors[i].pointer}, {"expected", errors[i].expected}});
  json details{{"errors", std::move(list)}};
  if (listed < errors.size())
    details["more"] = errors.size() - listed;
  return {error_code::schema_violation, summary(errors), errors.front().pointer,
          "correct every place that `errors` lists", details.dump()};
}

} // namespace roscell
