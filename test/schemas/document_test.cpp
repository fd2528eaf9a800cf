#include "schemas/document.hpp"

#include <catch2/catch.hpp>

#include <string>

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
