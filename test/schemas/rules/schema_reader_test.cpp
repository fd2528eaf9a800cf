#include "schemas/rules/schema_rule.hpp"

#include "schemas/schema_list.hpp"
#include "test/schemas/examples.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <set>

using namespace roscell;

namespace {

/// Calls `visit` with every subschema of a document and its place.
void for_each_schema(
    const json& schema, const json::json_pointer& at,
    const std::function<void(const json&, const json::json_pointer&)>& visit) {
  visit(schema, at);
  for (auto group : {"properties", "definitions"})
    if (schema.contains(group))
      for (const auto& [name, part] : schema[group].items())
        for_each_schema(part, at / group / name, visit);
  for (auto key : {"items", "additionalProperties", "propertyNames"})
    if (schema.contains(key))
      for_each_schema(schema[key], at / key, visit);
  if (schema.contains("oneOf"))
    for (size_t i = 0; i < schema["oneOf"].size(); ++i)
      for_each_schema(schema["oneOf"][i], at / "oneOf" / i, visit);
}

void for_each_schema(
    const std::vector<schema_entry>& schemas,
    const std::function<void(const json&, const std::string&)>& visit) {
  for (const auto& schema : schemas)
    for_each_schema(schema.document(), json::json_pointer{},
                    [&](const json& part, const json::json_pointer& at) {
                      visit(part,
                            std::string{schema.name} + "#" + at.to_string());
                    });
}

schema_rule rule_of(const char* text) {
  static std::deque<schema_reader> readers;
  return readers.emplace_back().read("x", json::parse(text));
}

} // namespace

TEST_CASE("every schema can be read") {
  schema_reader reader;
  CHECK(all_schemas().size() > 90);
  for (const auto& schema : all_schemas()) {
    INFO(schema.name);
    CHECK_NOTHROW(reader.rule(std::string{schema.name}));
  }
}

TEST_CASE("the schemas that are files are those of the folder") {
  for (const auto& schema : file_schemas()) {
    auto file = std::string{schema.name} + ".schema.json";
    auto document = schema.document();
    CHECK(schema.text
          == test::read_file(test::source_dir() / "schemas" / file));
    CHECK(document["$id"] == file);
    CHECK(document["$schema"] == "http://json-schema.org/draft-07/schema#");
    CHECK(document["x-kind"] == schema.kind);
    CHECK_FALSE(document.value("title", "").empty());
    CHECK_FALSE(document.value("description", "").empty());
  }
}

TEST_CASE("the type that a schema names is that of its file") {
  for (const auto& schema : all_schemas()) {
    auto type = schema.document().value("/properties/type"_json_pointer,
                                        json::object());
    if (type.contains("const"))
      CHECK(type["const"] == schema.name);
  }
}

TEST_CASE("every request may carry a request id") {
  for (const auto& schema : all_schemas())
    if (schema.kind == "request")
      CHECK(schema.document()["properties"].contains("request_id"));
}

TEST_CASE("every property in a file has a description, its own or that of its "
          "parts") {
  for_each_schema(
      file_schemas(), [](const json& schema, const std::string& at) {
        INFO(at);
        if (schema.contains("properties"))
          for (const auto& [name, part] : schema["properties"].items())
            CHECK((part.contains("description") || part.contains("$ref")));
        if (schema.contains("definitions"))
          for (const auto& [name, part] : schema["definitions"].items())
            CHECK((part.contains("description") || part.contains("items")));
      });
}

TEST_CASE("every string, array, map and number is bounded") {
  for_each_schema(all_schemas(), [](const json& schema, const std::string& at) {
    INFO(at);
    std::set<std::string> types;
    if (schema.contains("type") && schema["type"].is_array())
      types = schema["type"].get<std::set<std::string>>();
    else
      types.insert(schema.value("type", "none"));
    if (types.count("string") != 0)
      CHECK((schema.contains("maxLength") || schema.contains("enum")));
    if (types.count("array") != 0)
      CHECK((schema.contains("maxItems") && schema.contains("items")));
    if (types.count("integer") + types.count("number") != 0)
      CHECK((schema.contains("minimum") && schema.contains("maximum")));
    if (schema.contains("additionalProperties"))
      CHECK((schema.contains("maxProperties")
             && schema.contains("propertyNames")));
  });
}

TEST_CASE("every definition is used") {
  std::set<std::string> used;
  std::set<std::string> defined;
  for_each_schema(all_schemas(), [&](const json& schema, const std::string&) {
    if (auto reference = schema.value("$ref", ""); !reference.empty())
      used.insert(reference.substr(reference.find('#') + 1));
    if (schema.contains("definitions"))
      for (const auto& [name, part] : schema["definitions"].items())
        defined.insert("/definitions/" + name);
  });
  for (const auto& name : defined)
    CHECK((used.count(name) == 1 ? "" : name) == "");
}

TEST_CASE("the choices of oneOf have no kind of value in common") {
  size_t found = 0;
  auto check = [&](const std::string& name, json document) {
    ++found;
    schema_reader reader;
    uint8_t seen = 0;
    for (auto choice : reader.read(name, document).choices) {
      CHECK(choice->kinds != 0);
      CHECK((seen & choice->kinds) == 0);
      seen |= choice->kinds;
    }
  };
  for (const auto& schema : all_schemas()) {
    const auto document = schema.document();
    const auto definitions = document.value("definitions", json::object());
    for_each_schema(
        document, json::json_pointer{},
        [&](const json& part, const json::json_pointer& at) {
          INFO(schema.name << "#" << at.to_string());
          if (part.contains("oneOf"))
            check(std::string{schema.name},
                  {{"definitions", definitions}, {"oneOf", part["oneOf"]}});
        });
  }
  CHECK(found > 1);
}

TEST_CASE("a schema that the rules cannot express is refused") {
  for (auto text :
       {R"({"uniqueItems":true})", R"({"anyOf":[{}]})", R"({"type":"float"})",
        R"({"properties":{"a":{"format":"uri"}}})", R"({"required":["a"]})",
        R"({"items":{"$ref":"#/definitions/none"}})",
        R"({"items":{"$ref":"common.schema.json#/definitions/none"}})",
        R"({"items":{"$ref":"none.schema.json"}})"}) {
    INFO(text);
    CHECK_THROWS_AS(rule_of(text), std::logic_error);
  }
}

TEST_CASE("a rule says in words what it asks for") {
  auto words = [](const char* text) { return rule_text(rule_of(text)); };
  CHECK(words("{}") == "any value");
  CHECK(words(R"({"type":"string"})") == "a string");
  CHECK(words(R"({"type":"string","maxLength":63})")
        == "a string of at most 63 characters");
  CHECK(words(R"({"type":"string","minLength":1})")
        == "a string of at least 1 characters");
  CHECK(words(R"({"type":"array","minItems":1,"maxItems":4})")
        == "an array of 1 to 4 items");
  CHECK(words(R"({"type":"array","minItems":2,"maxItems":2})")
        == "an array of 2 items");
  CHECK(words(R"({"type":"object","maxProperties":9})")
        == "an object of at most 9 members");
  CHECK(words(R"({"type":"integer","minimum":0,"maximum":7})")
        == "an integer from 0 to 7");
  CHECK(words(R"({"type":"number","minimum":0.5})")
        == "a number of at least 0.5");
  CHECK(words(R"({"type":"number","maximum":-1})") == "a number of at most -1");
  CHECK(words(R"({"type":["integer","null"],"minimum":0,"maximum":255})")
        == "an integer from 0 to 255 or null");
  CHECK(words(R"({"type":"boolean"})") == "true or false");
  CHECK(words(R"({"enum":["cpu","gpu","npu"]})")
        == R"(one of "cpu", "gpu" or "npu")");
  CHECK(words(R"({"const":"task_request"})") == R"("task_request")");
  CHECK(
      words(
          R"({"description":"a vowel","type":"string","pattern":"^[aeiou]$"})")
      == "a vowel");
  CHECK(words(R"({"oneOf":[{"type":"object"},{"type":"array"}]})")
        == "an object or an array");
}
