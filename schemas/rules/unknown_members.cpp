#include "schemas/rules/unknown_members.hpp"

#include "schemas/closest_word.hpp"
#include "schemas/rules/schema_rule.hpp"
#include "schemas/text_excerpt.hpp"
#include "schemas/validator.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// What people write who come from other systems, and what it is called here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 20>
    known_as{{{"args", "parameters"},
              {"command", "entry_point"},
              {"constraints", "labels"},
              {"disk", "disk_mib"},
              {"env", "environment"},
              {"file", "endpoint"},
              {"format", "data_type"},
              {"gpu", "gpu_memory_mib"},
              {"image", "base_image"},
              {"memory", "memory_mib"},
              {"name", "id"},
              {"name", "task"},
              {"node", "labels"},
              {"params", "parameters"},
              {"path", "endpoint"},
              {"skill", "operation"},
              {"steps", "pipeline"},
              {"topic", "endpoint"},
              {"type", "data_type"},
              {"url", "endpoint"}}};

const schema_rule::member* find_member(const schema_rule& rule,
                                       std::string_view name) {
  const auto i = std::find_if(rule.members.begin(), rule.members.end(),
                              [&](const auto& x) { return x.name == name; });
  return i == rule.members.end() ? nullptr : &*i;
}

/// The member that was probably meant; empty if none comes to mind.
std::string_view meant_by(const schema_rule& rule, std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto& x : rule.members)
    names.emplace_back(x.name);
  if (const auto closest = closest_word(name, names); !closest.empty())
    return closest;
  for (const auto& [foreign, own] : known_as)
    if (foreign == name && find_member(rule, own) != nullptr)
      return own;
  return {};
}

std::string words_for(const schema_rule& rule, const std::string& name) {
  auto result = "there is no member " + in_quotes(name) + " here";
  if (const auto meant = meant_by(rule, name); !meant.empty())
    return result + "; did you mean " + in_quotes(meant) + "?";
  result += "; there are";
  for (const auto& x : rule.members)
    result += (&x == &rule.members.front() ? " " : ", ") + x.name;
  return result;
}

/// One walk over a document. Its depth is that of the schema, which is not
/// recursive.
class unknown_member_walk {
public:
  std::vector<schema_error> errors;

  void visit(const schema_rule& rule, const json& x) {
    for (const auto* choice : rule.choices)
      if (accepts_kind(*choice, x))
        return visit(*choice, x);
    if (x.is_object())
      visit_members(rule, x);
    else if (x.is_array() && rule.items != nullptr)
      for (size_t i = 0; i < x.size(); ++i)
        step_into(std::to_string(i), *rule.items, x[i]);
  }

private:
  static bool accepts_kind(const schema_rule& rule, const json& x) {
    return x.is_structured()
           && (rule.kinds & (x.is_object() ? kind_object : kind_array)) != 0;
  }

  void visit_members(const schema_rule& rule, const json& x) {
    for (const auto& [name, value] : x.items()) {
      if (const auto* known = find_member(rule, name))
        step_into(name, *known->rule, value);
      else if (rule.other_members != nullptr)
        step_into(name, *rule.other_members, value);
      else if (!rule.members.empty())
        refuse(rule, name);
    }
  }

  void refuse(const schema_rule& rule, const std::string& name) {
    if (errors.size() < validator::max_errors)
      errors.push_back({(here_ / name).to_string(), words_for(rule, name)});
  }

  void step_into(const std::string& name, const schema_rule& rule,
                 const json& x) {
    here_.push_back(name);
    visit(rule, x);
    here_.pop_back();
  }

  json::json_pointer here_;
};

} // namespace

std::vector<schema_error> unknown_members(const schema_rule& rule,
                                          const json& document) {
  unknown_member_walk result;
  result.visit(rule, document);
  return std::move(result.errors);
}

} // namespace roscell
