#include "messages/codec/json_codec.hpp"
#include "schemas/rules/schema_rule.hpp"
#include "schemas/validator.hpp"
#include "test/schemas/examples.hpp"

#include <catch2/catch.hpp>

#include <deque>
#include <stdexcept>
#include <thread>

using namespace roscell;

namespace {

std::vector<schema_error> errors_of(const char* schema, const json& document) {
  static std::deque<schema_reader> readers;
  return validate(readers.emplace_back().read("x", json::parse(schema)),
                  document);
}

using error_list = std::vector<schema_error>;

} // namespace

TEST_CASE("an error names the place, what was expected and what came") {
  CHECK(errors_of(R"({"type":"string","maxLength":63})", 7)
        == error_list{
            {"",
             "expected a string of at most 63 characters, got the number 7"}});
}

TEST_CASE("all errors of a document are reported at once") {
  auto schema = R"({"type":"object","required":["a","b"],"properties":{
    "a":{"type":"boolean"},"b":{"type":"null"},
    "c":{"type":"array","items":{"type":"integer","maximum":9}}}})";
  auto errors = errors_of(schema, json::parse(R"({"a":1,"c":[1,"x",10,2.5]})"));
  CHECK(errors
        == error_list{
            {"/a", "expected true or false, got the number 1"},
            {"/b", R"(expected "b", null, but it is missing)"},
            {"/c/1", R"(expected an integer of at most 9, got "x")"},
            {"/c/2", "expected an integer of at most 9, got the number 10"},
            {"/c/3", "expected an integer of at most 9, got the number 2.5"}});
}

TEST_CASE("pointers are escaped as RFC 6901 says") {
  auto schema = R"({"type":"object","additionalProperties":{"type":"null"}})";
  auto errors = errors_of(schema, {{"a/b~c", 1}});
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].pointer == "/a~1b~0c");
  CHECK(json({{"a/b~c", 1}})[json::json_pointer{errors[0].pointer}] == 1);
}

TEST_CASE("the choice of the value's own kind explains what is wrong") {
  auto schema = R"({"oneOf":[
    {"type":"object","required":["a"],"properties":{"a":{"type":"null"}}},
    {"type":"array","items":{"type":"string"}}]})";
  CHECK(errors_of(schema, json::object())
        == error_list{{"/a", R"(expected "a", null, but it is missing)"}});
  CHECK(errors_of(schema, {"x", 1})
        == error_list{{"/1", "expected a string, got the number 1"}});
  CHECK(
      errors_of(schema, 5)
      == error_list{{"", "expected an object or an array, got the number 5"}});
}

TEST_CASE("unknown members are ignored") {
  auto schema = R"({"type":"object","properties":{"a":{"type":"null"}}})";
  CHECK(errors_of(schema, {{"a", nullptr}, {"b", 7}}).empty());
}

TEST_CASE("names of members are checked, and described ones are not others") {
  auto schema = R"({"type":"object","properties":{"a":{"type":"null"}},
    "propertyNames":{"maxLength":2},"additionalProperties":{"type":"integer"}})";
  CHECK(errors_of(schema, {{"a", nullptr}, {"b", 7}}).empty());
  auto errors = errors_of(schema, {{"abc", 1}, {"d", "x"}});
  REQUIRE(errors.size() == 2);
  CHECK(errors[0].pointer == "/abc");
  CHECK(errors[1].pointer == "/d");
}

TEST_CASE("a number without a fraction is an integer") {
  CHECK(errors_of(R"({"type":"integer"})", 3.0).empty());
  CHECK(errors_of(R"({"type":"integer"})", 3.5).size() == 1);
  CHECK(errors_of(R"({"type":"number"})", 3).empty());
  CHECK(errors_of(R"({"type":"integer","minimum":0})", -0.5).size() == 1);
}

TEST_CASE("numbers beyond every integer type break the bounds") {
  auto schema = R"({"type":"integer","minimum":0,"maximum":9007199254740991})";
  CHECK(errors_of(schema, 9007199254740991).empty());
  CHECK(errors_of(schema, 9007199254740992).size() == 1);
  CHECK(errors_of(schema, 18446744073709551615ULL).size() == 1);
  CHECK(errors_of(schema, 1e300).size() == 1);
}

TEST_CASE("an array that is too long is one error, its items none") {
  json items(1'000'000, "x");
  auto schema = R"({"type":"array","maxItems":9,"items":{"type":"null"}})";
  CHECK(errors_of(schema, items)
        == error_list{{"", "expected an array of at most 9 items, got an array "
                           "of 1000000 items"}});
}

TEST_CASE("the number of collected errors is bounded") {
  json items(100'000, "x");
  auto errors = errors_of(R"({"type":"array","items":{"type":"null"}})", items);
  CHECK(errors.size() == validator::max_errors);
}

TEST_CASE("the length of a string counts characters") {
  auto schema = R"({"type":"string","maxLength":3})";
  CHECK(errors_of(schema, u8"äöü").empty());
  CHECK(errors_of(schema, u8"äöüx").size() == 1);
}

TEST_CASE("a name that no schema has is a defect of the caller") {
  CHECK_THROWS_AS(validator{}.validate("no_such_schema", {}), std::logic_error);
}

TEST_CASE("several threads may validate at once, from the first call on") {
  const auto all = test::examples();
  const validator shared;
  std::vector<size_t> wrong(4);
  std::vector<std::thread> threads;
  for (auto& count : wrong)
    threads.emplace_back([&] {
      for (const auto& x : all)
        if (x.valid && !shared.validate(x.type, x.document).empty())
          ++count;
    });
  for (auto& thread : threads)
    thread.join();
  CHECK(wrong == std::vector<size_t>(4));
}

TEST_CASE("one error becomes a refusal that says and shows it") {
  auto why = to_failure({{"/task", "expected a name, but it is missing"}});
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.where == "/task");
  CHECK(why.message == "/task: expected a name, but it is missing");
  auto errors = json::parse(why.details);
  CHECK(errors == json::parse(R"({"errors":[{"where":"/task",
             "expected":"expected a name, but it is missing"}]})"));
}

TEST_CASE("several errors are counted in the message and listed in full") {
  auto why = to_failure({{"", "expected a"}, {"/b", "expected c"}});
  CHECK(why.message == "the document: expected a (and 1 more error)");
  CHECK(json::parse(why.details)["errors"].size() == 2);
  CHECK_FALSE(json::parse(why.details).contains("more"));
}

TEST_CASE("of very many errors fifty are listed and the others counted") {
  auto why = to_failure(std::vector<schema_error>(73, {"/x", "expected y"}));
  auto details = json::parse(why.details);
  CHECK(details["errors"].size() == 50);
  CHECK(details["more"] == 23);
  CHECK(why.message == "/x: expected y (and 72 more errors)");
}
