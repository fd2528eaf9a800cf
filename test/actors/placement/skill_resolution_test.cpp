#include "actors/placement/skill_resolution.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

skill_row row(const std::string& hash, const std::string& operation,
              const std::vector<std::string>& models,
              const std::vector<std::string>& nodes) {
  skill_row result;
  result.skill.hash = hash;
  auto& descriptor = result.skill.descriptor;
  descriptor.operation = operation;
  descriptor.input = {{"image/png"}, {"file", "ros2"}};
  descriptor.output = {{"text/plain"}, {"file"}};
  for (const auto& name : models) {
    implementation_model model;
    model.name = name;
    for (const auto* option : {"cpu", "gpu"}) {
      deployment_option deployment;
      deployment.name = option;
      model.deployments.push_back(deployment);
    }
    descriptor.models.push_back(model);
  }
  result.nodes = nodes;
  return result;
}

task_step step(const std::string& operation, const std::string& model) {
  task_step result;
  result.id = "s";
  result.operation = operation;
  result.model = model;
  return result;
}

std::vector<skill_row> cell() {
  return {row("h1", "see", {"tag", "yolo"}, {"a"}),
          row("h2", "hear", {"wave"}, {"a", "b"})};
}

failure refusal(const std::vector<task_step>& steps,
                const std::vector<skill_row>& skills = cell(),
                const std::vector<refused_skill>& refused = {}) {
  const auto result = resolve_steps(steps, {skills, refused});
  REQUIRE(std::holds_alternative<failure>(result));
  return std::get<failure>(result);
}

std::vector<resolved_step>
resolved(const std::vector<task_step>& steps,
         const std::vector<skill_row>& skills = cell()) {
  const auto result = resolve_steps(steps, {skills, {}});
  REQUIRE(std::holds_alternative<std::vector<resolved_step>>(result));
  return std::get<std::vector<resolved_step>>(result);
}

} // namespace

TEST_CASE("A step is resolved to its skill, model and all its deployments",
          "[skill_resolution]") {
  const auto steps = resolved({step("see", "yolo"), step("hear", "wave")});
  REQUIRE(steps.size() == 2);
  REQUIRE(steps[0].builds.size() == 1);
  CHECK(steps[0].builds[0].hash == "h1");
  CHECK(steps[0].builds[0].model.name == "yolo");
  CHECK(steps[0].builds[0].model.deployments.size() == 2);
  CHECK(steps[1].builds[0].nodes == std::vector<std::string>{"a", "b"});
}

TEST_CASE("A named deployment is the only one left", "[skill_resolution]") {
  auto request = step("see", "tag");
  request.deployment = "gpu";
  const auto steps = resolved({request});
  const auto& options = steps[0].builds[0].model.deployments;
  REQUIRE(options.size() == 1);
  CHECK(options[0].name == "gpu");
}

TEST_CASE("An unknown operation is refused with those there are",
          "[skill_resolution]") {
  const auto why = refusal({step("see", "tag"), step("smell", "nose")});
  CHECK(why.code == error_code::unknown_operation);
  CHECK(why.where == "/pipeline/1/operation");
  CHECK(why.hint == "the operations are: see, hear");
  CHECK(refusal({step("see", "tag")}, {}).hint == "the operations are: none");
}

TEST_CASE("An unknown operation's hint tells which skills nodes have refused",
          "[skill_resolution]") {
  const refused_skill lame{"a", {"/s/smell", "/entry_point/0", "no program"}};
  const auto why = refusal({step("smell", "nose")}, cell(), {lame});
  CHECK(why.hint
        == "the operations are: see, hear; node 'a' refuses /s/smell: at "
           "/entry_point/0: no program");
  const auto many = refusal({step("smell", "nose")}, {}, {5, lame}).hint;
  CHECK(many.find("`roscell skills` shows more") != std::string::npos);
}

TEST_CASE("An operation in two versions is named once in a hint",
          "[skill_resolution]") {
  const auto why =
      refusal({step("smell", "nose")}, {row("h1", "see", {"tag"}, {"a"}),
                                        row("h2", "see", {"tag"}, {"b"})});
  CHECK(why.hint == "the operations are: see");
}

TEST_CASE("An unknown model is refused with those there are",
          "[skill_resolution]") {
  const auto why = refusal({step("see", "eye")});
  CHECK(why.code == error_code::unknown_model);
  CHECK(why.where == "/pipeline/0/model");
  CHECK(why.hint == "its models are: tag, yolo");
}

TEST_CASE("An unknown deployment is refused with those there are",
          "[skill_resolution]") {
  auto request = step("see", "tag");
  request.deployment = "tpu";
  const auto why = refusal({request});
  CHECK(why.code == error_code::unknown_deployment);
  CHECK(why.where == "/pipeline/0/deployment");
  CHECK(why.hint == "its deployment options are: cpu, gpu");
}

TEST_CASE("A protocol or data type that a skill does not take is refused",
          "[skill_resolution]") {
  auto request = step("see", "tag");
  request.input = {{"video", "/dev/video0", "image/png"}};
  auto why = refusal({request});
  CHECK(why.code == error_code::schema_violation);
  CHECK(why.where == "/pipeline/0/input/protocol");
  CHECK(why.hint == "it takes: file, ros2");

  request.input = {{"file", "/a", "image/png"}, {"ros2", "/b", "image/jpeg"}};
  why = refusal({request});
  CHECK(why.where == "/pipeline/0/input/1/data_type");
  CHECK(why.hint == "it takes: image/png");

  // An output has words of its own.
  request.input.clear();
  request.output = {{"ros2", "/t", "text/plain"}};
  CHECK(refusal({request}).where == "/pipeline/0/output/protocol");
}

TEST_CASE("Every node offers its own build, however few have that one",
          "[skill_resolution]") {
  const auto few = row("h1", "see", {"tag"}, {"a"});
  const auto many = row("h2", "see", {"tag"}, {"b", "c"});
  const auto builds = resolved({step("see", "tag")}, {few, many})[0].builds;
  REQUIRE(builds.size() == 2);
  CHECK(builds[0].hash == "h1");
  CHECK(builds[0].nodes == std::vector<std::string>{"a"});
  CHECK(builds[1].hash == "h2");
  CHECK(builds[1].nodes == std::vector<std::string>{"b", "c"});
}

TEST_CASE("Of several builds on a node the one added last is the candidate",
          "[skill_resolution]") {
  auto old = row("h1", "see", {"tag"}, {"a", "b"});
  old.added_unix_ms = {10, 30};
  auto later = row("h2", "see", {"tag"}, {"a", "b"});
  later.added_unix_ms = {20, 20};
  const auto builds = resolved({step("see", "tag")}, {later, old})[0].builds;
  REQUIRE(builds.size() == 2);
  // What came last to any node is first.
  CHECK(builds[0].hash == "h1");
  CHECK(builds[0].nodes == std::vector<std::string>{"b"});
  CHECK(builds[1].nodes == std::vector<std::string>{"a"});
}

TEST_CASE("A build that is a candidate nowhere is left out",
          "[skill_resolution]") {
  auto old = row("h1", "see", {"tag"}, {"a"});
  old.added_unix_ms = {10};
  auto later = row("h2", "see", {"tag"}, {"a"});
  later.added_unix_ms = {20};
  const auto builds = resolved({step("see", "tag")}, {old, later})[0].builds;
  REQUIRE(builds.size() == 1);
  CHECK(builds[0].hash == "h2");
}

TEST_CASE("A step that names a build gets it, also where there is a newer one",
          "[skill_resolution]") {
  auto old = row("0123456789abcdef", "see", {"tag"}, {"a"});
  auto later = row("fedcba9876543210", "see", {"tag"}, {"a", "b"});
  later.added_unix_ms = {20, 20};
  auto request = step("see", "tag");
  request.build = "01234567";
  const auto builds = resolved({request}, {old, later})[0].builds;
  REQUIRE(builds.size() == 1);
  CHECK(builds[0].hash == old.skill.hash);
  CHECK(builds[0].nodes == std::vector<std::string>{"a"});
  request.build = "89abcdef";
  const auto why = refusal({request}, {old, later});
  CHECK(why.code == error_code::unknown_operation);
  CHECK(why.where == "/pipeline/0/build");
  CHECK(why.hint == "its builds are: fedcba987654, 0123456789ab");
}

TEST_CASE("A build without the model, deployment or protocol does not count",
          "[skill_resolution]") {
  const auto right = row("h1", "see", {"yolo"}, {"a"});
  auto other = row("h2", "see", {"tag"}, {"a", "b"});
  other.added_unix_ms = {20, 20};
  auto request = step("see", "yolo");
  SECTION("model") {}
  SECTION("deployment") {
    request.deployment = "gpu";
    other.skill.descriptor.models[0].name = "yolo";
    other.skill.descriptor.models[0].deployments.pop_back();
  }
  SECTION("protocol") {
    request.input = {{"file", "/a", "image/png"}};
    other.skill.descriptor.models[0].name = "yolo";
    other.skill.descriptor.input.protocols = {"ros2"};
  }
  const auto builds = resolved({request}, {other, right})[0].builds;
  REQUIRE(builds.size() == 1);
  CHECK(builds[0].hash == "h1");
}

TEST_CASE("A hint names the models of all builds", "[skill_resolution]") {
  const auto right = row("h1", "see", {"yolo"}, {"a"});
  const auto other = row("h2", "see", {"tag"}, {"b", "c"});
  CHECK(refusal({step("see", "eye")}, {other, right}).hint
        == "its models are: tag, yolo");
}

namespace {

/// A step with its skill.
struct step_with_skill {
  task_step step;
  deployment_option option;
  skill_descriptor descriptor;

  life_policy life() const {
    return life_of(step, option, descriptor.safe_state);
  }

  std::string refused_at() const {
    const auto why = check_life(step, option, descriptor);
    return why ? why->where : "";
  }
};

} // namespace

TEST_CASE("After a boot a step goes on as it says, or as its skill says",
          "[life_resolution]") {
  step_with_skill x;
  CHECK(boot_action_of(x.life()) == boot_action::rejoin);
  x.option.on_boot = "start";
  CHECK(boot_action_of(x.life()) == boot_action::start);
  x.step.on_boot = "stay";
  CHECK(boot_action_of(x.life()) == boot_action::stay);
}

TEST_CASE(
    "What runs once, or must not be found moving, stays unless it says so",
    "[life_resolution]") {
  step_with_skill x;
  SECTION("it runs once") {
    x.step.restart = R"({"policy": "never"})";
  }
  SECTION("it has to be stop-safe before it ends") {
    x.descriptor.safe_state = true;
  }
  CHECK(boot_action_of(x.life()) == boot_action::stay);
  x.step.on_boot = "rejoin";
  CHECK(boot_action_of(x.life()) == boot_action::rejoin);
  CHECK(x.refused_at().empty());
}

TEST_CASE("What may be elsewhere by then does not start alone",
          "[life_resolution]") {
  step_with_skill x;
  x.step.on_boot = "start";
  CHECK(x.refused_at().empty());
  x.step.on_node_loss = R"({"policy": "move"})";
  CHECK(x.refused_at() == "/on_boot");
}

TEST_CASE("A robot that must be safe starts alone only where its skill says so",
          "[life_resolution]") {
  step_with_skill x;
  x.descriptor.safe_state = true;
  x.step.on_boot = "start";
  CHECK(x.refused_at() == "/on_boot");
  x.descriptor.may_start_alone = true;
  CHECK(x.refused_at().empty());
}

} // namespace roscell::test
