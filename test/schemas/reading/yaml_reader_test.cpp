#include "schemas/document.hpp"
#include "schemas/reading/yaml_reader.hpp"
#include "test/places.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

using namespace roscell;

namespace {

failure refusal(std::string_view text, const document_limits& limits = {}) {
  auto result = parse_document(text, document_format::yaml, limits);
  REQUIRE(std::holds_alternative<failure>(result));
  auto why = std::get<failure>(result);
  CHECK(why.code == error_code::malformed_json);
  CHECK_NOTHROW(error_reply(why).dump());
  return why;
}

json document(std::string_view text, const document_limits& limits = {}) {
  auto result = parse_document(text, document_format::yaml, limits);
  if (auto* why = std::get_if<failure>(&result))
    FAIL(why->message);
  return std::get<json>(result);
}

bool says(const failure& why, const std::string& words) {
  return why.message.find(words) != std::string::npos;
}

std::string repeat(std::string_view text, size_t n) {
  std::string result;
  for (size_t i = 0; i < n; ++i)
    result += text;
  return result;
}

/// The document as a person would write it: blocks, and no quotes where text
/// needs none.
std::string as_yaml(const json& value, const std::string& indent = "\n") {
  if (value.empty() || value.is_primitive())
    return " " + value.dump();
  std::string result;
  for (const auto& [name, item] : value.items())
    result += indent + (value.is_array() ? "-" : name + ":")
              + as_yaml(item, indent + "  ");
  return result + " # a comment";
}

} // namespace

TEST_CASE("a document in YAML means what it means in JSON") {
  CHECK(document(R"(# What to do.
task: t        # its name
pipeline:
  - id: a
    labels: { place: left, rack: "7" }
    parameters:
      rate_hz: 10
      scale: 0.5
      text: |
        two
        lines
  - {id: b, input: [], on: yes, "quoted": 'it''s', none: }
)") == json::parse(R"({"task": "t", "pipeline": [
    {"id": "a", "labels": {"place": "left", "rack": "7"},
     "parameters": {"rate_hz": 10, "scale": 0.5, "text": "two\nlines\n"}},
    {"id": "b", "input": [], "on": "yes", "quoted": "it's", "none": null}]})"));
}

TEST_CASE("each strategy of docs/examples is the same document in YAML") {
  auto count = 0;
  for (const auto& file : std::filesystem::directory_iterator{
           test::source_dir() / "docs/examples/strategies"}) {
    if (file.path().extension() != ".json")
      continue;
    INFO(file.path());
    std::ostringstream text;
    text << std::ifstream{file.path()}.rdbuf();
    const auto wanted = json::parse(text.str());
    CHECK(document(as_yaml(wanted)) == wanted);
    CHECK(document(text.str()) == wanted);
    ++count;
  }
  CHECK(count >= 3);
}

TEST_CASE("a file's name tells how it is written, else its first character") {
  CHECK(format_of("task.json", "a: 1") == document_format::json);
  CHECK(format_of("task.yaml", "{}") == document_format::yaml);
  CHECK(format_of("/x/task.yml", "[]") == document_format::yaml);
  CHECK(format_of("-", " \n\t{\"a\": 1}") == document_format::json);
  CHECK(format_of("task", "[1]") == document_format::json);
  CHECK(format_of("-", "type: cell_query") == document_format::yaml);
  CHECK(format_of("-", "# {}\n") == document_format::yaml);
  CHECK(format_of("-", "") == document_format::yaml);
}

TEST_CASE("what is in quotes is text, whatever it says") {
  CHECK(document("['7', \"true\", 'null', '~', '']")
        == json::parse(R"(["7", "true", "null", "~", ""])"));
}

TEST_CASE("a mark of the byte order moves no place") {
  CHECK(document("\xEF\xBB\xBF"
                 "a: 1")
        == json{{"a", 1}});
  CHECK(says(refusal("\xEF\xBB\xBF"
                     "a: 1\na: 2"),
             "line 2, column 1: "));
}

TEST_CASE("a YAML syntax error names line and column") {
  CHECK(refusal("task: t\npipeline: [\n  1,\n").message.rfind("line 4, ", 0)
        == 0);
  CHECK(refusal("a: b: c").message == "line 1, column 5: illegal map value");
  CHECK(refusal("a:\n\t- 1").message.rfind("line 2, ", 0) == 0);
  CHECK(refusal("a: 1\n b: 2").message.rfind("line 2, ", 0) == 0);
  CHECK(refusal("a: \"x").hint.find("YAML") != std::string::npos);
}

TEST_CASE("a YAML syntax error does not repeat the text that caused it") {
  CHECK(refusal("a: *" + std::string(100'000, 'x')).message.size() < 200);
  CHECK(refusal("a: !" + std::string(100'000, 'x')).message.size() < 200);
}

TEST_CASE("a name that stands twice in one mapping is refused with its place") {
  const auto why = refusal("a:\n  b: 1\n  c: 2\n  \"b\": 3\n");
  CHECK(says(why, R"(line 4, column 3: the name "b" stands twice)"));
  CHECK(why.where == "/a/b");
  CHECK_NOTHROW(document("- b: 1\n- b: 1\n  c: {b: 2}"));
}

TEST_CASE("a name that is no text is refused") {
  CHECK(says(refusal("a:\n  7: x"),
             "line 2, column 3: expected a name, got the number 7; write it "
             "in quotes"));
  for (const auto* text : {"true: 1", "~: 1", ": 1", "1.5: 1", "{a: 1, 2: 3}"})
    CHECK(says(refusal(text), "write it in quotes"));
  for (const auto* text : {"? [a]\n: 1", "? {a: 1}\n: 1", "{[a]: 1}"})
    CHECK(says(refusal(text), "expected a name"));
  CHECK(document("'7': x") == json{{"7", "x"}});
}

TEST_CASE("anchors and aliases are refused, so that none can multiply") {
  CHECK(says(refusal("a: &x 1"), "line 1, column 4: anchors"));
  for (const auto* text :
       {"&x a: 1", "a: &x\n", "a: &x [1]", "a: &x {b: 1}", "a: &x 'b'"})
    CHECK(says(refusal(text), "anchors"));
  refusal("a: *x");
  refusal("a: &a [x]\nb: &b [*a, *a]\nc: &c [*b, *b]");
}

TEST_CASE("tags are refused") {
  for (const auto* text :
       {"a: !!str 7", "a: !local x", "a: !!map {b: 1}", "a: !!seq [1]",
        "!!str a: 1", "a: !!null", "a: !!binary aGk="})
    CHECK(says(refusal(text), "tags"));
}

TEST_CASE("one text is one document") {
  CHECK(document("%YAML 1.2\n---\na: 1\n...\n") == json{{"a", 1}});
  CHECK(says(refusal("a: 1\n---\nb: 2"), "a second document"));
  for (const auto* text : {"", "\n", "# nothing", "   "})
    CHECK(says(refusal(text), "line 1, column 1: the document is empty"));
}

TEST_CASE("numbers that JSON has not are refused") {
  CHECK(says(refusal("a:\n- .inf"), "line 2, column 3: JSON has no such"));
  refusal("[.nan]");
  refusal("[1e999]");
}

TEST_CASE("YAML that is not UTF-8, or holds control characters, is refused") {
  for (const std::string& text :
       {std::string{"a: \xff"}, std::string{"a: \xc3"}, std::string{"a: \x04"},
        std::string{"a: \x1b[0m"}, std::string{"a: 1\0b", 6},
        std::string{"\xff\xfe"
                    "a\0",
                    4},
        std::string{"# \xed\xa0\x80"}})
    CHECK(says(refusal(text), "UTF-8"));
  CHECK(says(refusal("a: \xc3\xa4\xff"), "line 1, column 5: "));
  CHECK(document("a: \"\\u00e4\\n\"\r\nb: 1\r\n")
        == json::parse("{\"a\":\"\\u00e4\\n\",\"b\":1}"));
}

TEST_CASE("an escape that would become bytes that are no UTF-8 is refused") {
  for (const auto* text : {R"("a\N")", R"("\_": 1)", R"(- "\_")"})
    CHECK(says(refusal(text), "escapes"));
  CHECK(document(R"(["\u0085\u00a0\L\x41\U0001F916"])")
        == json::parse(R"(["\u0085\u00a0\u2028A\ud83e\udd16"])"));
}

TEST_CASE("a YAML document is bounded like JSON") {
  document_limits limits;
  limits.max_bytes = 10;
  limits.max_values = 4;
  CHECK(says(refusal("[1,2,3,456]", limits), "11 bytes; at most 10"));
  CHECK(document("[1,2,3]", limits).size() == 3);
  CHECK(says(refusal("[1,2,3,4]", limits), "at most 4"));
  CHECK(says(refusal(std::string(257, 'n') + ": 1"), "257 bytes"));
}

TEST_CASE(
    "nesting of YAML beyond the limit is refused, however it is written") {
  CHECK_NOTHROW(document(repeat("[", 64) + repeat("]", 64)));
  CHECK(says(refusal(repeat("[", 65) + repeat("]", 65)),
             "line 1, column 65: arrays and objects are nested too deep"));
  for (const auto* open : {"[", "- ", "{a: ", "? "})
    refusal(repeat(open, 100'000));
  std::string deep;
  for (size_t i = 0; i < 1000; ++i)
    deep += std::string(i, ' ') + "a:\n";
  CHECK(says(refusal(deep), "too deep"));
}

namespace {

json meant(const std::string& text) {
  const auto result = plain_scalar(text);
  INFO(text);
  REQUIRE(result);
  return *result;
}

} // namespace

TEST_CASE("null and booleans are the words of the core schema") {
  for (const auto* text : {"", "~", "null", "Null", "NULL"})
    CHECK(meant(text).is_null());
  for (const auto* text : {"true", "True", "TRUE"})
    CHECK(meant(text) == true);
  for (const auto* text : {"false", "False", "FALSE"})
    CHECK(meant(text) == false);
}

TEST_CASE("words that older YAML took for booleans are text") {
  for (const auto* text : {"yes", "no", "on", "off", "y", "nULL", "tRUE"})
    CHECK(meant(text) == text);
}

TEST_CASE("integers are decimal, octal or hexadecimal") {
  CHECK(meant("0").is_number_unsigned());
  CHECK(meant("7") == 7);
  CHECK(meant("+7") == 7);
  CHECK(meant("-7") == -7);
  CHECK(meant("007") == 7);
  CHECK(meant("0o17") == 15);
  CHECK(meant("0xfF") == 255);
  CHECK(meant("18446744073709551615") == std::numeric_limits<uint64_t>::max());
  CHECK(meant("-9223372036854775808") == std::numeric_limits<int64_t>::min());
}

TEST_CASE("an integer beyond 64 bits is a floating-point number, as in JSON") {
  CHECK(meant("18446744073709551616") == json::parse("18446744073709551616"));
  CHECK(meant("-9223372036854775809").is_number_float());
}

TEST_CASE("floating-point numbers are read as JSON reads them") {
  for (const auto* text : {"0.1", "-2.5e3", "1E-7", "1e308"})
    CHECK(meant(text) == json::parse(text));
  CHECK(meant(".5") == 0.5);
  CHECK(meant("5.") == 5.0);
  CHECK(meant("+.5e1") == 5.0);
}

TEST_CASE("a number that no double holds is none") {
  for (const auto* text : {".inf", "-.Inf", "+.INF", ".nan", ".NaN", "1e999",
                           "0xfffffffffffffffff"})
    CHECK_FALSE(plain_scalar(text));
  CHECK_FALSE(plain_scalar(std::string(5000, '9')));
}

TEST_CASE("what only looks like a number is text") {
  for (const auto* text : {"1.0.0",
                           "1_000",
                           "12:30",
                           "2026-11-22",
                           "-",
                           "+",
                           ".",
                           "..",
                           "e5",
                           "--5",
                           "+-5",
                           "0x",
                           "0xg",
                           "0o8",
                           "-0x1",
                           "1e",
                           "inf",
                           "nan",
                           "infinity",
                           ".infx",
                           "0.5cores",
                           "1 2",
                           "debian:bookworm-slim"})
    CHECK(meant(text) == text);
}
