#include "schemas/rules/schema_rule.hpp"

#include "schemas/schema_list.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// Keywords that say nothing about a value.
constexpr std::array<std::string_view, 8> annotations{
    "$schema", "$id",         "title",   "description",
    "x-kind",  "definitions", "x-reply", "default"};

json_kind kind_named(const std::string& word) {
  static constexpr std::array<std::pair<std::string_view, json_kind>, 7> kinds{
      {{"null", kind_null},
       {"boolean", kind_boolean},
       {"integer", kind_integer},
       {"number", kind_number},
       {"string", kind_string},
       {"array", kind_array},
       {"object", kind_object}}};
  for (const auto& [name, kind] : kinds)
    if (name == word)
      return kind;
  throw std::logic_error{"unknown type in a schema: " + word};
}

/// Sets `rule` from a keyword that has no subschema. False if it is none.
bool fill_scalar(schema_rule& rule, const std::string& keyword, const json& x) {
  if (keyword == "type")
    for (const auto& word : x.is_array() ? x : json::array({x}))
      rule.kinds |= kind_named(word.get<std::string>());
  else if (keyword == "minimum")
    rule.minimum = x.get<double>();
  else if (keyword == "maximum")
    rule.maximum = x.get<double>();
  else if (keyword == "minLength" || keyword == "minItems"
           || keyword == "minProperties")
    rule.min_size = x.get<uint32_t>();
  else if (keyword == "maxLength" || keyword == "maxItems"
           || keyword == "maxProperties")
    rule.max_size = x.get<uint32_t>();
  else if (keyword == "enum")
    rule.words = x.get<std::vector<std::string>>();
  else if (keyword == "const")
    rule.words = {x.get<std::string>()};
  else if (keyword == "pattern")
    rule.pattern.emplace(x.get_ref<const std::string&>());
  else
    return std::find(annotations.begin(), annotations.end(), keyword)
           != annotations.end();
  return true;
}

std::string document_of(const std::string& reference) {
  return reference.substr(0, reference.find('.'));
}

} // namespace

const schema_rule& schema_reader::rule(const std::string& name) {
  const auto key = name + ".schema.json";
  if (auto i = slots_.find(key); i != slots_.end())
    return i->second;
  for (const auto& schema : all_schemas())
    if (schema.name == name)
      return read(name, schema.document());
  throw std::logic_error{"no schema has the name " + name};
}

const schema_rule& schema_reader::read(const std::string& name,
                                       const json& document) {
  const auto file = name + ".schema.json";
  const auto prefix = file + "#/definitions/";
  const auto definitions = document.value("definitions", json::object());
  // Schemas refer to each other, so all have a place before any is filled.
  auto& result = slots_[file];
  for (const auto& [key, schema] : definitions.items())
    slots_[prefix + key];
  for (const auto& [key, schema] : definitions.items())
    fill(slots_[prefix + key], name, schema);
  fill(result, name, document);
  return result;
}

const schema_rule* schema_reader::part(const std::string& name,
                                       const json& schema) {
  auto reference = schema.find("$ref");
  if (reference == schema.end()) {
    auto& result = parts_.emplace_back();
    fill(result, name, schema);
    return &result;
  }
  auto target = reference->get<std::string>();
  if (target.front() == '#')
    target.insert(0, name + ".schema.json");
  else
    rule(document_of(target));
  auto found = slots_.find(target);
  if (found == slots_.end())
    throw std::logic_error{name + ": nothing has the name " + target};
  return &found->second;
}

void schema_reader::fill(schema_rule& rule, const std::string& name,
                         const json& schema) {
  for (const auto& [keyword, argument] : schema.items()) {
    if (keyword == "items")
      rule.items = part(name, argument);
    else if (keyword == "propertyNames")
      rule.member_names = part(name, argument);
    else if (keyword == "additionalProperties")
      rule.other_members = part(name, argument);
    else if (keyword == "oneOf")
      for (const auto& choice : argument)
        rule.choices.push_back(part(name, choice));
    else if (keyword == "properties" || keyword == "required")
      continue;
    else if (!fill_scalar(rule, keyword, argument))
      throw std::logic_error{name + ": unsupported keyword " + keyword};
  }
  if (rule.pattern)
    rule.pattern_text = schema.at("description").get<std::string>();
  if (rule.pattern || !rule.words.empty())
    rule.kinds = kind_string;
  fill_members(rule, name, schema);
}

void schema_reader::fill_members(schema_rule& rule, const std::string& name,
                                 const json& schema) {
  const auto required = schema.value("required", std::vector<std::string>{});
  const auto members = schema.value("properties", json::object());
  for (const auto& key : required)
    if (!members.contains(key))
      throw std::logic_error{name + ": required but not described: " + key};
  for (const auto& [key, member] : members.items()) {
    auto is_required =
        std::find(required.begin(), required.end(), key) != required.end();
    rule.members.push_back({key, part(name, member), is_required});
  }
}

} // namespace roscell
