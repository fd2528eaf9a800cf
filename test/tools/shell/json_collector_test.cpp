#include "tools/roscell/shell/json_collector.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

#include <initializer_list>

using namespace roscell::cli;

namespace {

/// What is wrong with a request of these lines.
std::string errors_of(std::initializer_list<const char*> lines) {
  json_collector request;
  for (const auto* line : lines)
    request.add_line(line);
  CHECK_FALSE(request.is_open());
  return request.errors();
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

TEST_CASE("an unknown type is told in its line", "[shell]") {
  const auto said = errors_of({"{", "  \"type\": \"cel_query\"", "}"});
  CHECK(has(said, "request.json:2:3: no message type is named \"cel_query\""));
  CHECK(has(said, "cell_query"));
}

TEST_CASE("all that is wrong with a whole request is told, each in its line",
          "[shell]") {
  const auto said =
      errors_of({"{\"type\": \"task_request\",", " \"tsk\": \"t\",",
                 "\"task\": 7,", "\"pipeline\": [", "{\"input\": {}}]}"});
  CHECK(has(said, "request.json:2:2: there is no member \"tsk\" here"));
  CHECK(has(said, "  2 |  \"tsk\": \"t\","));
  CHECK(has(said, "request.json:3:1: "));
  CHECK(has(said, "request.json:5:1: expected \"id\", a name"));
}

TEST_CASE("a syntax error is told in its line", "[shell]") {
  CHECK(has(errors_of({"{\"type\": \"cell_query\",", "oops: 1,", "}"}),
            "request.json:2:"));
}

TEST_CASE("a forgotten quote hides no brace", "[shell]") {
  CHECK(has(errors_of({"{\"type: 1,", "}"}), "request.json:1:"));
}

TEST_CASE("what is missing of a request is told", "[shell]") {
  CHECK(
      has(errors_of({R"({"type": "task_request", "task": "t"})"}), "pipeline"));
}

TEST_CASE("what stands behind a request is an error", "[shell]") {
  CHECK(
      has(errors_of({R"({"type": "cell_query"} tasks)"}), "request.json:1:2"));
}
