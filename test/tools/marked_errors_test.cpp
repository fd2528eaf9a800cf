#include "tools/roscell/view/marked_errors.hpp"

#include "messages/failure.hpp"
#include "schemas/message_catalogue.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

std::string marks_for(const std::string& text) {
  const auto why = validate_request(json::parse(text));
  REQUIRE(why);
  return cli::marked_errors("task.json", text, error_reply(*why));
}

} // namespace

TEST_CASE("a wrong place is shown with its line and a mark under it") {
  CHECK(
      marks_for(R"({"type": "task_request", "task": "t", "pipeline": [
  {"id": "a", "operation": "echo",
   "model": "plain", "label": {"place": "left"}}]})")
      == R"(task.json:3:22: there is no member "label" here; did you mean "labels"?
  3 |    "model": "plain", "label": {"place": "left"}}]}
    |                      ^~~~~~~
)");
}

TEST_CASE("each wrong place is shown, and ten of many") {
  const auto two = marks_for(R"({"type": "task_query",
"colour": 1,
"shape": 2})");
  CHECK(two.find("task.json:2:1: ") != std::string::npos);
  CHECK(two.find("task.json:3:1: ") != std::string::npos);
  json many{{"type", "task_query"}};
  for (int i = 0; i < 20; ++i)
    many["odd" + std::to_string(i)] = i;
  const auto marks = marks_for(many.dump(0));
  CHECK(std::count(marks.begin(), marks.end(), '^') == 10);
  CHECK(marks.substr(marks.size() - 9) == "and more\n");
}

TEST_CASE("wrong places are shown in the order of the file") {
  const auto marks = marks_for(R"({"type": "task_request", "task": "t",
"pipeline": [{
"model": 1,
"zzz": 2,
"aaa": 3,
"operation": 4,
"id": 5}]})");
  size_t before = 0;
  for (const auto* at : {":3:1: ", ":4:1: ", ":5:1: ", ":6:1: ", ":7:1: "}) {
    INFO(marks);
    const auto found = marks.find(at);
    REQUIRE(found != std::string::npos);
    CHECK(found >= before);
    before = found;
  }
}

TEST_CASE("a member that is missing is named at what should have it") {
  const auto marks = marks_for(R"({"type": "task_request", "pipeline": [
{"id": "a", "operation": "echo", "model": "m"}]})");
  CHECK(marks.find("task.json:1:1: expected \"task\", a name: ")
        != std::string::npos);
}

TEST_CASE("of a long line the part around the place is shown") {
  const auto marks = marks_for(
      R"({"type": "task_query", "task": ")" + std::string(60, 'x')
      + R"(", "colour": 1, "request_id": ")" + std::string(100, 'y') + R"("})");
  const auto line = marks.find("  1 | ");
  const auto mark = marks.find("    | ", line + 6);
  REQUIRE(mark != std::string::npos);
  const auto shown = marks.substr(line + 6, mark - line - 7);
  CHECK(shown.size() == 100);
  CHECK(shown.substr(39, 8) == "\"colour\"");
  CHECK(marks.substr(mark + 6, 47) == std::string(39, ' ') + "^~~~~~~~");
}

TEST_CASE("tabs and control characters do not move the mark") {
  const auto marks = marks_for("{\t\"type\":\t\"task_query\",\t\"odd\": 1}");
  CHECK(marks.find("  1 | { \"type\": \"task_query\", \"odd\": 1}\n")
        != std::string::npos);
}

TEST_CASE(
    "a refusal that names no place, or a text that is no JSON, has none") {
  CHECK(
      cli::marked_errors("f", "{}", error_reply({error_code::timeout, "late"}))
          .empty());
  CHECK(cli::marked_errors("f", "{",
                           error_reply({error_code::conflict, "no", "/task"}))
            .empty());
}

TEST_CASE("a wrong place is marked in YAML as in JSON") {
  const std::string text = "# A request.\ntype: task_query\ncolour: red\n";
  const auto why = validate_request(
      json::parse(R"({"type": "task_query", "colour": "red"})"));
  REQUIRE(why);
  const auto marks = cli::marked_errors("task.yaml", text, error_reply(*why));
  CHECK(marks.rfind("task.yaml:3:1: there is no member \"colour\" here", 0)
        == 0);
  CHECK(marks.find("\n  3 | colour: red\n    | ^~~~~~\n") != std::string::npos);
}

TEST_CASE("where a text cannot be read is marked") {
  const auto reply = error_reply({error_code::malformed_json, "?"});
  CHECK(cli::marked_errors("-", "a: 1\na: 2", reply)
        == "standard input:2:1: the name \"a\" stands twice in one object; "
           "expected it once\n  2 | a: 2\n    | ^\n");
  CHECK(
      cli::marked_errors("f.json", "{\"a\" 1}", reply).rfind("f.json:1:6: ", 0)
      == 0);
}

TEST_CASE("a mark stands under a wide character as under any other") {
  const auto marks = marks_for(R"({"type": "cell_query", "机器": 1, "x": 2})");
  INFO(marks);
  CHECK(marks.find("    | " + std::string(23, ' ') + "^~~~~~\n")
        != std::string::npos);
  CHECK(marks.find("    | " + std::string(34, ' ') + "^~~\n")
        != std::string::npos);
}
