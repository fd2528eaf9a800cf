#include "schemas/rules/field_schema.hpp"

#include "schemas/schema_list.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <string>

using namespace roscell;

namespace {

enum class colour { red, green };

constexpr auto enum_words(colour) {
  return std::array<std::string_view, 2>{"red", "green"};
}

struct painted_end {
  std::string node;
  colour state = colour::red;

  static constexpr auto fields() {
    return field_list{required("node", &painted_end::node),
                      optional("state", &painted_end::state)};
  }
};

struct painting {
  std::vector<std::string> gone;
  bool wet = false;
  std::string body;
  std::vector<painted_end> spec;
  std::vector<painted_end> target;

  static constexpr auto fields() {
    return field_list{
        required("gone", &painting::gone), optional("wet", &painting::wet),
        raw_json("body", &painting::body), one_or_many("spec", &painting::spec),
        one_or_many("target", &painting::target)};
  }
};

struct unruled_text {
  std::string whatever;

  static constexpr auto fields() {
    return field_list{required("whatever", &unruled_text::whatever)};
  }
};

struct unruled_list {
  std::vector<std::string> node;

  static constexpr auto fields() {
    return field_list{required("node", &unruled_list::node)};
  }
};

bool is_bounded(const json& rule) {
  if (rule.contains("$ref") || rule.contains("enum") || rule.contains("const"))
    return true;
  if (rule.contains("oneOf"))
    return std::all_of(rule["oneOf"].begin(), rule["oneOf"].end(), is_bounded);
  const auto type = rule.value("type", "");
  if (type == "object") {
    const auto& members = rule.at("properties");
    return std::all_of(members.begin(), members.end(), is_bounded);
  }
  if (type == "array")
    return rule.contains("maxItems") && is_bounded(rule.at("items"));
  if (type == "string")
    return rule.contains("maxLength");
  if (type == "integer")
    return rule.contains("minimum") && rule.contains("maximum");
  return type == "boolean";
}

} // namespace

TEST_CASE("a schema that is made of fields says what they do") {
  const auto end = json::parse(R"({
    "type": "object", "required": ["node"], "properties": {
      "node": {"$ref": "common.schema.json#/definitions/name"},
      "state": {"type": "string", "enum": ["red", "green"]}}})");
  const auto schema = field_schemas::of_fields<painting>();
  CHECK(schema["required"] == json::array({"gone", "body"}));
  const auto& members = schema["properties"];
  CHECK(members["wet"] == json{{"type", "boolean"}});
  CHECK(members["gone"] == json::parse(R"({
    "type": "array", "maxItems": 10000,
    "items": {"$ref": "common.schema.json#/definitions/uuid"}})"));
  CHECK(members["body"]["required"] == json::array({"type"}));
  CHECK(members["target"] == end);
  CHECK(members["spec"]["oneOf"][0] == end);
  CHECK(members["spec"]["oneOf"][1]["maxItems"] == 1);
}

TEST_CASE("a field that no rule bounds has no schema") {
  CHECK_THROWS_AS(field_schemas::of_fields<unruled_text>(), std::logic_error);
  CHECK_THROWS_AS(field_schemas::of_fields<unruled_list>(), std::logic_error);
}

TEST_CASE("the schema of every message that only nodes exchange bounds each of "
          "its fields") {
  CHECK(node_schemas().size() > 30);
  for (const auto& schema : node_schemas()) {
    INFO(schema.name);
    CHECK(is_bounded(schema.document()));
  }
}

TEST_CASE("no message has two schemas") {
  const auto all = all_schemas();
  const auto two =
      std::adjacent_find(all.begin(), all.end(),
                         [](auto& x, auto& y) { return x.name == y.name; });
  CHECK((two == all.end() ? "" : two->name) == "");
}
