#include "actors/placement/reading/task_reading.hpp"
#include "test/actors/placement/reading/pipelines.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

failure refusal(const std::string& pipeline) {
  const auto result =
      read_task("t", steps_in(pipeline), {vision_skills(), {}, {}});
  REQUIRE(std::holds_alternative<failure>(result));
  return std::get<failure>(result);
}

std::string poses_with(const std::string& parameters) {
  return R"([{"id": "p", "operation": "poses", "model": "m",
              "input": "/tmp/x.png", "parameters": )"
         + parameters + "}]";
}

} // namespace

TEST_CASE("A task is read with its short forms, skills and wiring",
          "[task_reading]") {
  const auto result = read_task("t", steps_in(R"([
        {"id": "c", "operation": "camera", "model": "m", "input": "/d/x.png"},
        {"id": "p", "operation": "poses", "model": "m",
         "input": {"from": "c"}, "parameters": {"tag_size_m": 0.16},
         "output": "/tmp/poses.jsonl"}])"),
                                {vision_skills(), {}, {}});
  REQUIRE(std::holds_alternative<task_reading>(result));
  const auto& reading = std::get<task_reading>(result);
  REQUIRE(reading.steps.size() == 2);
  CHECK(reading.steps[1].step.input.size() == 2);
  CHECK(reading.steps[1].builds.front().hash == "poses");
  CHECK(reading.warnings.empty());
}

TEST_CASE("A parameter that the model does not have is refused with its like",
          "[task_reading]") {
  const auto why = refusal(poses_with(R"({"tag_size": 0.16})"));
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.where == "/pipeline/0/parameters/tag_size");
  CHECK(why.message.find(R"(did you mean "tag_size_m"?)") != std::string::npos);
}

TEST_CASE("A parameter outside its range is refused with the range and unit",
          "[task_reading]") {
  const auto why = refusal(poses_with(R"({"tag_size_m": 160})"));
  CHECK(why.where == "/pipeline/0/parameters/tag_size_m");
  CHECK(why.message.find("a number from 0.0001 to 100 (m)")
        != std::string::npos);
}

namespace {

/// A cell whose `run` is a ROS 2 program, whose `big` takes any text, and whose
/// `act` is an actor.
failure refusal_of_programs(const std::string& pipeline) {
  const port_description text{{"text/plain"}, {"file"}};
  auto run = skill_of("run", text, text, R"({"at": {"type": "array"}})");
  run.skill.descriptor.engine = "ros2_standalone";
  run.skill.descriptor.ros2.resize(1);
  auto act = skill_of("act", text, text);
  act.skill.descriptor.engine = "actor";
  const auto big = skill_of("big", text, text, R"({"text": "", "more": ""})");
  const auto result =
      read_task("t", steps_in(pipeline), {{{run, act, big}, {}}, {}, {}});
  REQUIRE(std::holds_alternative<failure>(result));
  return std::get<failure>(result);
}

} // namespace

TEST_CASE("What a ROS 2 program cannot be given is refused with its place",
          "[task_reading]") {
  const auto why = refusal_of_programs(R"([
    {"id": "r", "operation": "run", "model": "m", "parameters": {"at": []}}])");
  CHECK(why.where == "/pipeline/0/parameters/at");
  CHECK(why.message.find("cannot be given an empty one") != std::string::npos);
}

TEST_CASE("Parameters that fit into no variable are refused",
          "[task_reading]") {
  const auto why = refusal_of_programs(
      R"([{"id": "b", "operation": "big", "model": "m", "parameters": {"text": ")"
      + std::string(100'000, 'x') + R"(", "more": ")"
      + std::string(100'000, 'y') + R"("}}])");
  CHECK(why.where == "/pipeline/0/parameters");
  CHECK(why.message.find("at most 128 KiB") != std::string::npos);
}

TEST_CASE("An actor of a running program gets neither env nor arguments",
          "[task_reading]") {
  const auto why = refusal_of_programs(R"([
    {"id": "a", "operation": "act", "model": "m", "env": {"A": "b"},
     "arguments": ["c"]}])");
  CHECK(why.where == "/pipeline/0/env");
  CHECK(json::parse(why.details).at("errors").size() == 2);
}

TEST_CASE("Every wrong place of a request is told at once", "[task_reading]") {
  const auto why = refusal(R"([
    {"id": "p", "operation": "poses", "model": "m", "input": "/no/image",
     "parameters": {"tag_size": 1, "queue_length": "two"}}])");
  const auto errors = json::parse(why.details)["errors"];
  REQUIRE(errors.size() == 3);
  CHECK(errors[0]["where"] == "/pipeline/0/parameters/queue_length");
  CHECK(errors[1]["where"] == "/pipeline/0/parameters/tag_size");
  CHECK(errors[2]["where"] == "/pipeline/0/input");
}

TEST_CASE("Steps that share files are told to the search", "[task_reading]") {
  const auto result = read_task("t", steps_in(R"([
        {"id": "a", "operation": "echo", "model": "m", "input": "/tmp/in",
         "output": "/tmp/between"},
        {"id": "b", "operation": "echo", "model": "m",
         "input": {"from": "a.between"}, "output": "/tmp/out"}])"),
                                {vision_skills(), {}, {}});
  REQUIRE(std::holds_alternative<task_reading>(result));
  const auto& steps = std::get<task_reading>(result).steps;
  CHECK(steps[0].together == 1);
  CHECK(steps[1].together == 1);
}

TEST_CASE("Images in an encoding that their reader does not take are refused "
          "with both places",
          "[task_reading]") {
  auto skills = vision_skills();
  skills.skills[1].skill.descriptor.models[0].parameters =
      R"({"encodings": ["mono8", "nv12"]})";
  const auto read = [&](const std::string& encoding) {
    return read_task("t",
                     steps_in(R"([
        {"id": "c", "operation": "camera", "model": "m", "input": "/d/x.png",
         "parameters": {"encoding": ")"
                              + encoding + R"("}},
        {"id": "p", "operation": "poses", "model": "m",
         "input": {"from": "c"}, "output": "/tmp/poses.jsonl"}])"),
                     {skills, {}, {}});
  };
  CHECK(std::holds_alternative<task_reading>(read("mono8")));
  const auto refused = read("bgr8");
  REQUIRE(std::holds_alternative<failure>(refused));
  const auto& why = std::get<failure>(refused);
  CHECK(why.where == "/pipeline/1/input");
  CHECK(why.message.find(R"(step "c" (at )") != std::string::npos);
  CHECK(why.message.find(
            R"(encoding "bgr8", but step "p" takes only mono8, nv12)")
        != std::string::npos);
}

} // namespace roscell::test
