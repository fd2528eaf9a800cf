#include "schemas/rules/field_schema.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace roscell::field_schemas {

namespace {

/// A rule, and the fields that it holds for, each between spaces.
template <class Rule>
using row = std::pair<Rule, std::string_view>;

/// A definition of schemas/common.schema.json, or a schema.
constexpr row<std::string_view> value_rules[] = {
    {"address", " address discovery_server remote "},
    {"architecture", " architecture "},
    {"counter", " count epoch id incarnation revocations size "},
    {"domain_id", " domain_id "},
    {"hash", " hash "},
    {"hex_digits", " build_key nonce proof "},
    {"instance_id", " instance instances reserved "},
    {"parameters", " parameters "},
    {"name", " cell coordinator name node nodes step target task "},
    {"node_state", " state "},
    {"server_id", " remote_id server_id "},
    {"text", " reason status "},
    {"transfer_id", " transfer "},
    {"unix_ms", " since_unix_ms until_unix_ms "},
    {"uuid", " cell_uuid gone server_cell uuid "},
    {"version", " version "},
    {R"({"enum": ["coordinator"]})", " role "},
    {R"({"type": "integer", "minimum": 0, "maximum": 600000})", " hold_ms "},
    {R"({"description": "a session id: 16 hexadecimal digits, small letters",
         "type": "string", "maxLength": 16, "pattern": "^[0-9a-f]{16}$"})",
     " session "},
    {R"({"description": "an image: 1 to 512 characters without spaces",
         "type": "string", "maxLength": 512, "pattern": "^[!-~]{1,512}$"})",
     " image "},
    {R"({"description": "a SHA-256 as container engines write it",
         "type": "string", "maxLength": 71,
         "pattern": "^sha256:[0-9a-f]{64}$"})",
     " image_id layers "},
    {R"({"type": "integer", "minimum": 0, "maximum": 17179869184})", " bytes "},
    // Any message, which is checked against its own schema.
    {R"({"type": "object", "required": ["type"], "properties":
         {"type": {"type": "string", "minLength": 1, "maxLength": 64}}})",
     " body "},
};

/// How many items a list may have; 0: one stands alone, never in a list.
constexpr row<size_t> list_rules[] = {
    {0, " target "},
    {1, " discovery spec "},
    {128, " refused specs "},
    {512, " layers "},
    {1024, " refused_skills skills "},
    {10000, " changed gone instances members nodes reserved waiting "},
    {20000, " verdicts "},
};

template <class Rule, size_t Size>
Rule rule_for(std::string_view field, const row<Rule> (&rules)[Size]) {
  const auto word = " " + std::string{field} + " ";
  for (const auto& [rule, fields] : rules)
    if (fields.find(word) != std::string_view::npos)
      return rule;
  throw std::logic_error{"no rule bounds what is in a field of the name"
                         + word};
}

} // namespace

json named(std::string_view field) {
  const auto rule = rule_for(field, value_rules);
  return rule.front() == '{' ? json::parse(rule) : definition(rule);
}

json list(std::string_view field, const json& items) {
  const auto most = rule_for(field, list_rules);
  return {{"type", "array"}, {"maxItems", most}, {"items", items}};
}

json one_or_list(std::string_view field, const json& items) {
  if (rule_for(field, list_rules) == 0)
    return items;
  return {{"oneOf", {items, list(field, items)}}};
}

json definition(std::string_view name) {
  return {{"$ref", "common.schema.json#/definitions/" + std::string{name}}};
}

json empty_object() {
  return {{"type", "object"},
          {"required", json::array()},
          {"properties", json::object()}};
}

void add_member(json& object, const char* name, json rule, bool required) {
  object["properties"][name] = std::move(rule);
  if (required)
    object["required"].push_back(name);
}

} // namespace roscell::field_schemas
