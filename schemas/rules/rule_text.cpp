#include "schemas/rules/schema_rule.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

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

namespace {

using word_pair = std::pair<std::string_view, std::string_view>;

/// What people write who come from other systems, and what it is called here:
/// of two that a place has the first one counts.
constexpr std::array known_as{
    word_pair{"affinity", "labels"},
    word_pair{"annotations", "labels"},
    word_pair{"args", "arguments"},
    word_pair{"args", "parameters"},
    word_pair{"arch", "architectures"},
    word_pair{"attempts", "max_attempts"},
    word_pair{"backoffLimit", "restart"},
    word_pair{"cap_add", "capabilities"},
    word_pair{"cmd", "entry_point"},
    word_pair{"command", "entry_point"},
    word_pair{"command", "arguments"},
    word_pair{"config", "parameters"},
    word_pair{"configMap", "parameters"},
    word_pair{"constraint", "labels"},
    word_pair{"constraints", "labels"},
    word_pair{"container_name", "id"},
    word_pair{"containers", "pipeline"},
    word_pair{"cores", "cpu"},
    word_pair{"cpus", "cpu"},
    word_pair{"depends_on", "input"},
    word_pair{"disk", "disk_mib"},
    word_pair{"driver", "engine"},
    word_pair{"entrypoint", "entry_point"},
    word_pair{"env", "environment"},
    word_pair{"environment", "env"},
    word_pair{"ephemeral-storage", "disk_mib"},
    word_pair{"ephemeral_disk", "disk_mib"},
    word_pair{"file", "endpoint"},
    word_pair{"format", "data_type"},
    word_pair{"gpu", "gpu_memory_mib"},
    word_pair{"healthcheck", "health"},
    word_pair{"host", "labels"},
    word_pair{"hostname", "labels"},
    word_pair{"image", "base_image"},
    word_pair{"image", "operation"},
    word_pair{"interval", "reset_after_s"},
    word_pair{"job", "task"},
    word_pair{"jobs", "pipeline"},
    word_pair{"livenessProbe", "health"},
    word_pair{"max_restarts", "max_attempts"},
    word_pair{"max_retries", "max_attempts"},
    word_pair{"max_retries", "restart"},
    word_pair{"maximum_retry_count", "max_attempts"},
    word_pair{"mem_limit", "memory_mib"},
    word_pair{"memory", "memory_mib"},
    word_pair{"memory_mb", "memory_mib"},
    word_pair{"meta", "labels"},
    word_pair{"mode", "policy"},
    word_pair{"mounts", "volumes"},
    word_pair{"name", "id"},
    word_pair{"name", "task"},
    word_pair{"node", "labels"},
    word_pair{"nodeAffinity", "labels"},
    word_pair{"nodeName", "labels"},
    word_pair{"nodeSelector", "labels"},
    word_pair{"options", "parameters"},
    word_pair{"params", "parameters"},
    word_pair{"path", "endpoint"},
    word_pair{"placement", "labels"},
    word_pair{"priorityClassName", "priority"},
    word_pair{"privileged", "capabilities"},
    word_pair{"readinessProbe", "health"},
    word_pair{"requests", "resources"},
    word_pair{"limits", "resources"},
    word_pair{"reschedule", "on_node_loss"},
    word_pair{"restartPolicy", "restart"},
    word_pair{"restart_policy", "restart"},
    word_pair{"retries", "max_attempts"},
    word_pair{"retries", "restart"},
    word_pair{"services", "pipeline"},
    word_pair{"skill", "operation"},
    word_pair{"spec", "pipeline"},
    word_pair{"steps", "pipeline"},
    word_pair{"stop_grace_period", "safe_timeout_s"},
    word_pair{"tasks", "pipeline"},
    word_pair{"terminationGracePeriodSeconds", "safe_timeout_s"},
    word_pair{"tolerations", "on_node_loss"},
    word_pair{"topic", "endpoint"},
    word_pair{"type", "data_type"},
    word_pair{"url", "endpoint"},
    word_pair{"volumeMounts", "volumes"},
};

/// What has no member of its own anywhere, and what is done instead.
constexpr std::array explained{
    word_pair{"count", "a step is one instance: write a step for each"},
    word_pair{"replicas", "a step is one instance: write a step for each"},
    word_pair{"scale", "a step is one instance: write a step for each"},
    word_pair{"expose", "an instance has the network of its host"},
    word_pair{"network_mode", "an instance has the network of its host"},
    word_pair{"networks", "an instance has the network of its host"},
    word_pair{"ports", "an instance has the network of its host"},
    word_pair{"limits", "what it needs is said by its skill.json"},
    word_pair{"memory", "what it needs is said by its skill.json"},
    word_pair{"resources", "what it needs is said by its skill.json"},
    word_pair{"devices", "what it needs is said by its skill.json"},
    word_pair{"volumes", "what it needs is said by its skill.json"},
    word_pair{"user", "--grant of its node says what user it has"},
};

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

std::string unknown_member_text(const schema_rule& rule,
                                const std::string& name) {
  auto result = "there is no member " + in_quotes(name) + " here";
  if (const auto meant = meant_by(rule, name); !meant.empty())
    return result + "; did you mean " + in_quotes(meant) + "?";
  for (const auto& [foreign, instead] : explained)
    if (foreign == name)
      return result + ": " + std::string{instead};
  result += "; there are";
  for (const auto& x : rule.members)
    result += (&x == &rule.members.front() ? " " : ", ") + x.name;
  return result;
}

} // namespace roscell
