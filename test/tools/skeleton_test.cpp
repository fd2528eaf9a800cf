#include "tools/roscell/tasks/known_skills.hpp"

#include "actors/placement/reading/task_reading.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "test/actors/placement/reading/pipelines.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/task_replies.hpp"

#include <catch2/catch.hpp>

namespace roscell::cli {

namespace {

using test::vision_skills;

json document_in(const std::string& skeleton) {
  auto parsed = parse_document(skeleton, document_format::yaml);
  REQUIRE(std::holds_alternative<json>(parsed));
  return std::get<json>(parsed);
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("a task skeleton is a valid request whatever it is made of") {
  const std::vector<std::vector<std::string>> pipelines{
      {"echo"},
      {"camera"},
      {"poses"},
      {"camera", "poses"},
      {"echo", "echo"},
      {"poses", "camera"},
      {"camera", "poses", "poses"},
      {"camera", "echo"},
      {"echo", "poses"}};
  for (const auto& operations : pipelines) {
    const auto text = task_skeleton("my_task", operations, vision_skills());
    INFO(text);
    const auto document = document_in(text);
    CHECK_FALSE(validate_request(document));
    const auto request = document.get<task_request>();
    CHECK(request.pipeline.size() == operations.size());
    const auto reading =
        read_task(request.task, request.pipeline, {vision_skills(), {}, {}});
    CHECK(std::holds_alternative<task_reading>(reading));
  }
}

TEST_CASE("a step of a task skeleton reads the one before it") {
  const auto text = task_skeleton("t", {"camera", "poses"}, vision_skills());
  CHECK(says(text, "input: {from: camera}"));
  CHECK(says(text, "tag_size_m: 0.08  # a number from 0.0001 to 100 (m)"));
}

TEST_CASE("a task skeleton of an unknown operation names the one meant") {
  try {
    task_skeleton("t", {"camra"}, vision_skills());
    FAIL("nothing was thrown");
  } catch (const command_error& e) {
    CHECK(e.hint == "did you mean 'camera'?");
  }
}

TEST_CASE("a skill is shown with the meaning of its parameters") {
  auto skills = vision_skills();
  const auto text = skill_view({skills.skills[1]}, {});
  CHECK(says(text, "model m"));
  CHECK(says(text, "tag_size_m"));
  CHECK(says(text, "a number from 0.0001 to 100 (m)"));
  // Of the engine, too.
  CHECK(says(text, "queue_length"));
  CHECK(says(text, "Frames of one input that may wait"));
}

} // namespace roscell::cli
