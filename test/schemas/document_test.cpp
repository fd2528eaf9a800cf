#include "messages/task.hpp"
#include "schemas/document.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <tuple>

using namespace roscell;

namespace {

failure refusal(std::string_view text, const document_limits& limits = {}) {
  auto result = parse_document(text, limits);
  REQUIRE(std::holds_alternative<failure>(result));
  auto why = std::get<failure>(result);
  CHECK(why.code == error_code::malformed_json);
  CHECK_NOTHROW(error_reply(why).dump());
  return why;
}

json document(std::string_view text, const document_limits& limits = {}) {
  auto result = parse_document(text, limits);
  if (auto why = std::get_if<failure>(&result))
    FAIL(why->message);
  return std::get<json>(result);
}

std::string repeat(std::string_view text, size_t n) {
  std::string result;
  for (size_t i = 0; i < n; ++i)
    result += text;
  return result;
}

} // namespace

TEST_CASE("every kind of value is parsed") {
  auto text = R"( {"a":[null,true,false,-7,18446744073709551615,0.5,"\u00e4\n"],
                   "b":{"c":[],"d":{}}} )";
  CHECK(document(text) == json::parse(text));
  CHECK(document("7") == 7);
  CHECK(document("\xef\xbb\xbf[]") == json::array());
}

TEST_CASE("a syntax error names line, column and what was expected") {
  auto why = refusal("{\n  \"task\": \"a\",\n  \"b\" 1\n}");
  CHECK(why.message
        == "line 3, column 7: unexpected number literal; expected ':'");
  CHECK(why.where == "/b");
  CHECK(refusal("[1,").message.rfind("line 1, column 4: unexpected end", 0)
        == 0);
  CHECK(refusal("").message.rfind("line 1, column 1: unexpected end", 0) == 0);
  CHECK(refusal("{} x").message.find("expected end of input")
        != std::string::npos);
}

TEST_CASE("columns count characters, not bytes") {
  CHECK(refusal(u8"[\"äöü\" 1]").message.rfind("line 1, column 8", 0) == 0);
}

TEST_CASE("a syntax error does not repeat the text that caused it") {
  auto why = refusal("\"" + std::string(500'000, 'x'));
  CHECK(why.message.size() < 200);
}

TEST_CASE("the error points to the value that was being read") {
  CHECK(refusal(R"({"a":{"b":[1,{"c/d":tru}]}})").where == "/a/b/1/c~1d");
}

TEST_CASE("a document of more than the maximum size is refused unread") {
  document_limits limits;
  limits.max_bytes = 10;
  CHECK(document("[1,2,3,45]", limits).size() == 4);
  CHECK(refusal("[1,2,3,456]", limits).message
        == "the document has 11 bytes; at most 10 are taken");
  CHECK(refusal(std::string(100'000'000, '[')).message.size() < 100);
}

TEST_CASE("nesting beyond the limit is refused without recursion") {
  CHECK_NOTHROW(document(repeat("[", 64) + repeat("]", 64)));
  auto why = refusal(repeat("[", 65) + repeat("]", 65));
  CHECK(why.message.rfind("line 1, column 65: ", 0) == 0);
  CHECK(why.message.find("64 levels") != std::string::npos);
  refusal(repeat("[", 100'000));
  refusal(repeat(R"({"a":)", 100'000));
}

TEST_CASE("very deep documents are parsed and freed where they are allowed") {
  document_limits limits;
  limits.max_depth = 300'000;
  limits.max_values = 300'000;
  auto text = repeat("[", 200'000) + repeat("]", 200'000);
  CHECK(std::holds_alternative<json>(parse_document(text, limits)));
}

TEST_CASE("more values than the limit are refused") {
  document_limits limits;
  limits.max_values = 4;
  CHECK_NOTHROW(document("[1,2,3]", limits));
  CHECK(refusal("[1,2,3,4]", limits).message.find("at most 4")
        != std::string::npos);
  refusal("[" + repeat("{},", 200'000) + "0]");
}

TEST_CASE("a name that stands twice in one object is refused") {
  auto why = refusal(R"({"a":{"b":1,"c":2,"b":3}})");
  CHECK(why.message.find(R"("b" stands twice)") != std::string::npos);
  CHECK(why.where == "/a/b");
  CHECK_NOTHROW(document(R"([{"b":1},{"b":1,"c":{"b":2}}])"));
}

TEST_CASE("a name longer than the limit is refused") {
  CHECK_NOTHROW(document("{\"" + std::string(256, 'n') + "\":1}"));
  auto why = refusal("{\"" + std::string(257, 'n') + "\":1}");
  CHECK(why.message.find("257 bytes; at most 256") != std::string::npos);
  CHECK(why.message.size() < 200);
}

TEST_CASE("text that is not UTF-8 is refused") {
  for (auto bytes : {"\"\xff\"", "\"\xc3\"", "\"\xc0\x80\"", "\"\xed\xa0\x80\"",
                     "{\"\xfe\":1}", "\xff\xfe", "\"\\ud800\""}) {
    INFO(bytes);
    refusal(bytes);
  }
}

TEST_CASE("numbers that no double can hold are refused") {
  CHECK(refusal("[1e999]").message.find("too large") != std::string::npos);
  refusal("[-1e999]");
  refusal("[NaN]");
  refusal("[Infinity]");
  refusal("[" + std::string(5000, '9') + "]");
  CHECK(document("[1e308,123456789012345678901234567890]").size() == 2);
}

TEST_CASE("comments, trailing commas and single quotes are refused") {
  refusal("[1] // one");
  refusal("[1,]");
  refusal("{\"a\":1,}");
  refusal("['a']");
  refusal("{a:1}");
}

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

TEST_CASE("a message is decoded to its struct") {
  auto result = decode<task_query>({{"type", "task_query"}, {"task", "a"}});
  REQUIRE(std::holds_alternative<task_query>(result));
  CHECK(std::get<task_query>(result).task == "a");
}

TEST_CASE("a part of a message needs no type") {
  auto result = decode<io_endpoint>(
      {{"protocol", "file"}, {"endpoint", "/a"}, {"data_type", "x"}});
  CHECK(std::holds_alternative<io_endpoint>(result));
}

TEST_CASE("a message of another type is refused") {
  auto result = decode<task_query>({{"type", "task_request"}});
  REQUIRE(std::holds_alternative<failure>(result));
  CHECK(std::get<failure>(result).code == error_code::unknown_type);
}

TEST_CASE("what the struct cannot hold is a refusal, not an exception") {
  for (const json& document :
       {json{{"type", "task_termination"}}, json(7), json(nullptr),
        json{{"type", "task_termination"}, {"task", 7}}}) {
    auto result = decode<task_termination>(document);
    REQUIRE(std::holds_alternative<failure>(result));
    CHECK(std::get<failure>(result).code == error_code::schema_violation);
  }
}

TEST_CASE("an unknown word of an enumeration is a refusal") {
  auto result = decode<task_row>({{"task", "a"},
                                  {"state", "asleep"},
                                  {"submitted_unix_ms", 0},
                                  {"instances", json::array()}});
  CHECK(std::holds_alternative<failure>(result));
}
