#include "tools/roscell/shell/json_collector.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

#include <initializer_list>

using namespace roscell::cli;

namespace {

/// What is said after the last of these lines.
std::string said_after(json_collector& request,
                       std::initializer_list<const char*> lines) {
  std::string said;
  for (const auto* line : lines)
    said = request.add_line(line);
  return said;
}

using roscell::test::has;

} // namespace

TEST_CASE("a request begins with a brace", "[shell]") {
  CHECK(json_collector::begins("{"));
  CHECK(json_collector::begins(" \t{\"type\""));
  CHECK_FALSE(json_collector::begins("tasks {"));
  CHECK_FALSE(json_collector::begins(""));
}

TEST_CASE("a request goes on until its braces close", "[shell]") {
  json_collector request;
  CHECK_FALSE(request.is_open());
  request.add_line("{\"type\": \"cell_query\",");
  CHECK(request.is_open());
  request.add_line("\"request_id\": \"a}b\\\"}\"");
  CHECK(request.is_open());
  request.add_line("}");
  CHECK_FALSE(request.is_open());
  CHECK(request.errors().empty());
  CHECK(request.one_line()
        == R"({"type": "cell_query", "request_id": "a}b\"}" })");
}

TEST_CASE("a part of a request is not blamed for what may come", "[shell]") {
  json_collector request;
  for (const auto* line :
       {"{", "\"type\":", "\"task_request\"", ",", "\"task\"", ":", "\"t\",",
        "\"pipeline\": [", "{", "\"id\": \"a\",", "\"operation\": \"echo\"",
        ",\"input\": {\"protocol\":", "\"file\""}) {
    INFO(line);
    CHECK(request.add_line(line).empty());
  }
}

TEST_CASE("an unknown type is told in its line, once", "[shell]") {
  json_collector request;
  const auto said = said_after(request, {"{", "  \"type\": \"cel_query\","});
  CHECK(has(said, "request.json:2:3: no message type is named \"cel_query\""));
  CHECK(has(said, "cell_query"));
  CHECK(request.add_line("  \"x\": 1,").empty());
}

TEST_CASE("an unknown member is told in its line, once", "[shell]") {
  json_collector request;
  const auto said =
      said_after(request, {"{\"type\": \"task_request\",", " \"tsk\": \"t\","});
  CHECK(has(said, "request.json:2:2: there is no member \"tsk\" here"));
  CHECK(has(said, "  2 |  \"tsk\": \"t\","));
  CHECK(request.add_line(" \"task\": \"t\",").empty());
}

TEST_CASE("a value of the wrong kind is told in its line", "[shell]") {
  json_collector request;
  const auto said =
      said_after(request, {"{\"type\": \"task_request\",", "\"task\": 7,"});
  CHECK(has(said, "request.json:2:1: "));
  CHECK(has(said, "got"));
}

TEST_CASE("what is missing is told when its object has ended", "[shell]") {
  json_collector request;
  const auto said =
      said_after(request, {"{\"type\": \"task_request\", \"task\": \"t\",",
                           "\"pipeline\": [", "{\"input\": {}}"});
  CHECK(has(said, "request.json:3:1: expected \"id\", a name"));
  CHECK(has(said, "but it is missing"));
}

TEST_CASE("a syntax error is told in its line, once", "[shell]") {
  json_collector request;
  const auto said =
      said_after(request, {"{\"type\": \"cell_query\",", "oops: 1,"});
  CHECK(has(said, "request.json:2:"));
  CHECK(request.add_line("\"a\": 1").empty());
  request.add_line("}");
  CHECK_FALSE(request.is_open());
  CHECK(has(request.errors(), "request.json:2:"));
}

TEST_CASE("a forgotten quote hides no brace", "[shell]") {
  json_collector request;
  const auto said = request.add_line("{\"type: 1,");
  CHECK(has(said, "request.json:1:"));
  request.add_line("}");
  CHECK_FALSE(request.is_open());
}

TEST_CASE("a whole request is checked against its schema", "[shell]") {
  json_collector request;
  request.add_line(R"({"type": "task_request", "task": "t"})");
  CHECK_FALSE(request.is_open());
  CHECK(has(request.errors(), "pipeline"));
}

TEST_CASE("what stands behind a request is an error", "[shell]") {
  json_collector request;
  request.add_line(R"({"type": "cell_query"} tasks)");
  CHECK_FALSE(request.is_open());
  CHECK(has(request.errors(), "request.json:1:2"));
}
