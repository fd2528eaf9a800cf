#include "actors/placement/reading/step_copies.hpp"
#include "test/actors/placement/reading/pipelines.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

std::vector<task_step> copied(const std::string& pipeline) {
  auto result = with_copies(steps_in(pipeline));
  if (const auto* why = std::get_if<failure>(&result))
    FAIL(why->where << ": " << why->message);
  return std::get<std::vector<task_step>>(result);
}

failure refused_copies(const std::string& pipeline) {
  const auto result = with_copies(steps_in(pipeline));
  REQUIRE(std::holds_alternative<failure>(result));
  return std::get<failure>(result);
}

std::string step_text(const std::string& id, const std::string& more) {
  return R"({"id": ")" + id + R"(", "operation": "o", "model": "m", )" + more
         + "}";
}

std::string many_steps(size_t count) {
  std::string result = "[";
  for (size_t i = 0; i < count; ++i)
    result += (i == 0 ? "" : ",")
              + step_text("s" + std::to_string(i), R"("input": "/a")");
  return result;
}

} // namespace

TEST_CASE("Each copy of a step is a step with its number", "[copies]") {
  const auto steps = copied(
      "[" + step_text("a", R"("input": "/in/${copy}", "output": "/out/${copy}",
                         "env": {"N": "${copy}"}, "arguments": ["-${copy}"],
                         "parameters": {"n": "${copy}", "t": "no ${copy}"},
                         "copies": 3)")
      + "]");
  REQUIRE(steps.size() == 3);
  for (size_t i = 0; i < steps.size(); ++i) {
    const auto number = std::to_string(i + 1);
    const auto& x = steps[i];
    CHECK(x.id == "a-" + number);
    CHECK(x.copies == 1);
    CHECK(x.input.front().endpoint == "/in/" + number);
    CHECK(x.output.front().endpoint == "/out/" + number);
    CHECK(x.env.at("N") == number);
    CHECK(x.arguments.front() == "-" + number);
    const auto parameters = json::parse(x.parameters);
    CHECK(parameters.at("n") == static_cast<int>(i + 1));
    CHECK(parameters.at("t") == "no " + number);
  }
}

TEST_CASE("A step without copies stays as it is, also done again", "[copies]") {
  const auto once =
      copied("[" + step_text("a", R"("input": "/${copy}")") + ","
             + step_text("b", R"("input": "/b", "copies": 2)") + "]");
  REQUIRE(once.size() == 3);
  CHECK(once.front().input.front().endpoint == "/${copy}");
  const auto again = with_copies(once);
  CHECK(std::get<std::vector<task_step>>(again) == once);
}

TEST_CASE("Copies cannot share an output", "[copies]") {
  const auto why = refused_copies("[" + step_text("a", R"("input": "/in",
      "output": ["/${copy}/x", "/$${copy}"], "copies": 2)")
                                  + "]");
  CHECK(why.where == "/pipeline/0/output/1");
  CHECK(why.message.find("all 2 copies of step 'a'") != std::string::npos);
  CHECK(copied("[" + step_text("a", R"("input": "/in", "output": "/out",
      "copies": 1)")
               + "]")
            .size()
        == 1);
}

TEST_CASE("An input names one copy of a step", "[copies]") {
  const auto reader = [](const std::string& from) {
    return "[" + step_text("a", R"("input": "/in", "copies": 2)") + ","
           + step_text("b",
                       R"("input": {"from": ")" + from + R"("}, "copies": 2)")
           + "]";
  };
  const auto why = refused_copies(reader("a"));
  CHECK(why.where == "/pipeline/1/input/from");
  CHECK(why.hint.find("'a-1'") != std::string::npos);
  CHECK(refused_copies(reader("a.image")).where == "/pipeline/1/input/from");
  const auto steps = copied(reader("a-${copy}.image"));
  CHECK(steps[2].input.front().from == "a-1.image");
  CHECK(steps[3].input.front().from == "a-2.image");
}

TEST_CASE("Copies have ids of their own", "[copies]") {
  const auto why =
      refused_copies("[" + step_text("a-1", R"("input": "/in")") + ","
                     + step_text("a", R"("input": "/in", "copies": 2)") + "]");
  CHECK(why.where == "/pipeline/1/id");
  const std::string longest(61, 'x');
  CHECK(copied("[" + step_text(longest, R"("input": "/in", "copies": 9)") + "]")
            .size()
        == 9);
  CHECK(refused_copies(
            "[" + step_text(longest, R"("input": "/in", "copies": 10)") + "]")
            .where
        == "/pipeline/0/id");
}

TEST_CASE("With its copies a task has no more steps than any", "[copies]") {
  const auto some = [](size_t others, int copies) {
    return many_steps(others) + ","
           + step_text("c",
                       R"("input": "/in", "copies": )" + std::to_string(copies))
           + "]";
  };
  CHECK(copied(some(64, 64)).size() == 128);
  CHECK(refused_copies(some(65, 64)).where == "/pipeline/65/copies");
}

} // namespace roscell::test
