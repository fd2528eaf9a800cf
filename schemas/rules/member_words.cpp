#include "schemas/rules/member_words.hpp"

#include "schemas/closest_word.hpp"
#include "schemas/rules/schema_rule.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

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

/// The member that was probably meant; empty if none comes to mind.
std::string_view meant_by(const schema_rule& rule, std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto& x : rule.members)
    names.emplace_back(x.name);
  if (const auto closest = closest_word(name, names); !closest.empty())
    return closest;
  for (const auto& [foreign, own] : known_as)
    if (foreign == name && rule.find_member(own) != nullptr)
      return own;
  return {};
}

} // namespace

std::string unknown_member_words(const schema_rule& rule,
                                 const std::string& name) {
  auto result = "there is no member " + in_quotes(name) + " here";
  if (const auto meant = meant_by(rule, name); !meant.empty())
    return result + "; did you mean " + in_quotes(meant) + "?";
  result += "; there are";
  for (const auto& x : rule.members)
    result += (&x == &rule.members.front() ? " " : ", ") + x.name;
  return result;
}

} // namespace roscell
