#include "schemas/document_place.hpp"

#include <catch2/catch.hpp>

#include <tuple>

using namespace roscell;

namespace {

constexpr const char* text = R"({
  "task": "t",
  "pipeline": [
    {"id": "a", "labels": {"a/b": "x"}, "größe": 7},
    {"id" : "b", "list": [1, -2.5e3 , "z\"}", null, {"k": []}]}
  ]
})";

/// Line, column and length.
std::tuple<size_t, size_t, size_t> place(const std::string& pointer,
                                         const char* document = text) {
  const auto found = find_place(document, document_format::json, pointer);
  REQUIRE(found);
  return {found->line, found->column, found->length};
}

} // namespace

TEST_CASE("a pointer leads to the name of a member") {
  CHECK(place("/task") == std::tuple{2, 3, 6});
  CHECK(place("/pipeline") == std::tuple{3, 3, 10});
  CHECK(place("/pipeline/1/id") == std::tuple{5, 6, 4});
  CHECK(place("/pipeline/0/labels/a~1b") == std::tuple{4, 28, 5});
  CHECK(find_place(text, document_format::json, "/task")->text
        == R"(  "task": "t",)");
}

TEST_CASE("a pointer leads to an item of an array") {
  CHECK(place("/pipeline/0") == std::tuple{4, 5, 1});
  CHECK(place("/pipeline/1/list/0") == std::tuple{5, 27, 1});
  CHECK(place("/pipeline/1/list/1") == std::tuple{5, 30, 6});
  CHECK(place("/pipeline/1/list/2") == std::tuple{5, 39, 6});
  CHECK(place("/pipeline/1/list/3") == std::tuple{5, 47, 4});
  CHECK(place("/pipeline/1/list/4/k") == std::tuple{5, 54, 3});
}

TEST_CASE("the column of a place counts characters") {
  CHECK(place("/pipeline/0/größe") == std::tuple{4, 41, 7});
}

TEST_CASE("what is missing is looked for where it should be") {
  CHECK(place("") == std::tuple{1, 1, 1});
  CHECK(place("/reply") == std::tuple{1, 1, 1});
  CHECK(place("/pipeline/0/model") == std::tuple{4, 5, 1});
  CHECK(place("/pipeline/7") == std::tuple{3, 3, 10});
  CHECK(place("/task/x/y") == std::tuple{2, 3, 6});
}

TEST_CASE("a number at the very end of a list is as long as it is") {
  CHECK(place("/0", "[12]") == std::tuple{1, 2, 2});
  CHECK(place("/a", R"({"a":1})") == std::tuple{1, 2, 3});
  CHECK(place("", "17") == std::tuple{1, 1, 2});
}

TEST_CASE("what is no JSON has no places") {
  for (const auto* broken : {"", "{", "[1,", "{\"a\":1}}", "nonsense"})
    CHECK_FALSE(find_place(broken, document_format::json, "/a"));
}

namespace {

constexpr const char* yaml = R"(# A task.
task: t
pipeline:
  - id: a
    labels: {a/b: x, größe: 7}
  - "id" : 'b''c'
    list: [1, -2.5e3 , "z\"}", null, {k: []}]
    text: |
      lines
    plain: more words # and a comment
  -
    - below
)";

std::tuple<size_t, size_t, size_t> yaml_place(const std::string& pointer,
                                              const char* document = yaml) {
  const auto found = find_place(document, document_format::yaml, pointer);
  REQUIRE(found);
  return {found->line, found->column, found->length};
}

} // namespace

TEST_CASE("a pointer leads to the name of a member in YAML") {
  CHECK(yaml_place("/task") == std::tuple{2, 1, 4});
  CHECK(yaml_place("/pipeline") == std::tuple{3, 1, 8});
  CHECK(yaml_place("/pipeline/0/labels/a~1b") == std::tuple{5, 14, 3});
  CHECK(yaml_place("/pipeline/0/labels/größe") == std::tuple{5, 22, 5});
  CHECK(yaml_place("/pipeline/1/id") == std::tuple{6, 5, 4});
  CHECK(yaml_place("/pipeline/1/text") == std::tuple{8, 5, 4});
}

TEST_CASE("a pointer leads to an item of an array in YAML") {
  CHECK(yaml_place("/pipeline/0") == std::tuple{4, 5, 1});
  CHECK(yaml_place("/pipeline/1/list/0") == std::tuple{7, 12, 1});
  CHECK(yaml_place("/pipeline/1/list/1") == std::tuple{7, 15, 6});
  CHECK(yaml_place("/pipeline/1/list/2") == std::tuple{7, 24, 6});
  CHECK(yaml_place("/pipeline/1/list/3") == std::tuple{7, 32, 1});
  CHECK(yaml_place("/pipeline/1/list/4/k") == std::tuple{7, 39, 1});
  CHECK(yaml_place("/pipeline/2/0") == std::tuple{12, 7, 5});
  CHECK(yaml_place("/0", "- two words # comment") == std::tuple{1, 3, 9});
  CHECK(yaml_place("/0", "- 'it''s' # comment") == std::tuple{1, 3, 7});
  CHECK(yaml_place("/0", "- |\n  x") == std::tuple{1, 3, 1});
}

TEST_CASE("what is missing in YAML is looked for where it should be") {
  CHECK(yaml_place("/reply") == std::tuple{2, 1, 1});
  CHECK(yaml_place("/pipeline/0/model") == std::tuple{4, 5, 1});
  CHECK(yaml_place("/pipeline/7") == std::tuple{3, 1, 8});
}

TEST_CASE("what is no YAML has no places") {
  for (const auto* broken : {"", "a: [", "a: b: c", "a: *x"})
    CHECK_FALSE(find_place(broken, document_format::yaml, "/a"));
}

TEST_CASE("the place of what cannot be read is told with the reason") {
  const auto problem = find_problem("a: 1\nb: 2\na: 3", document_format::yaml);
  REQUIRE(problem);
  CHECK(problem->at.line == 3);
  CHECK(problem->at.column == 1);
  CHECK(problem->at.text == "a: 3");
  CHECK(problem->words.rfind("the name \"a\" stands twice", 0) == 0);
  CHECK(find_problem("{\"a\" 1}", document_format::json)->at.column == 6);
  CHECK_FALSE(find_problem("a: 1", document_format::yaml));
}
