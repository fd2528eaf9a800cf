#include "actors/instances/life/instance_text.hpp"
#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

TEST_CASE("an exit code is told as people know it") {
  CHECK(exit_code_text(0) == "with exit code 0");
  CHECK(exit_code_text(127) == "with exit code 127");
  CHECK(exit_code_text(128) == "with exit code 128");
  CHECK(exit_code_text(139) == "by signal 11");
  CHECK(exit_code_text(-1) == "in an unknown way");
}

TEST_CASE("out of memory is told with what it may have and what it took") {
  instance_row row;
  row.exit_code = 137;
  row.spec.resources.memory_mib = 64;
  CHECK(end_reason_text(row, end_cause::usual, 64) == "it ended by signal 9");
  CHECK(end_reason_text(row, end_cause::memory, 63.9)
        == "out of memory: it may use 64 MiB, and took 64 MiB");
  CHECK(end_reason_text(row, end_cause::memory, -1)
        == "out of memory: it may use 64 MiB");
  CHECK(end_reason_text(row, end_cause::memory, 20)
        == "out of memory: its host had no more; it took 20 MiB, and may use "
           "64 MiB");
  row.spec.resources.memory_mib = 0;
  CHECK(end_reason_text(row, end_cause::memory, 20)
        == "out of memory: its host had no more; it took 20 MiB");
  CHECK(end_reason_text(row, end_cause::memory, -1)
        == "out of memory: its host had no more");
  row.exit_code = -1;
  CHECK(end_reason_text(row, end_cause::supervision, -1)
        == "its supervision was ended from outside, and its program with it");
}

TEST_CASE("the last bytes of a text begin with a whole line") {
  CHECK(last_bytes("short", 10) == "short");
  CHECK(last_bytes("first\nsecond\nthird\n", 10) == "third\n");
  CHECK(last_bytes("no newline at all", 6) == "at all");
  CHECK(last_bytes("ends in one line\n", 5) == "line\n");
  CHECK(last_bytes("", 0).empty());
}

TEST_CASE("a character that the bound cuts is replaced") {
  CHECK(last_bytes("a\xC3\xA4", 1) == "\xEF\xBF\xBD");
}

TEST_CASE("an unknown exit code is null in the details of a failure") {
  instance_row row;
  row.spec.instance = "i";
  row.node = "n";
  row.state = instance_state::failed;
  row.reason = "no such program";
  const auto why = deployment_failure(row);
  CHECK(why.code == error_code::engine_failed);
  CHECK(why.message == "instance 'i' on node 'n' failed: no such program");
  CHECK(json::parse(why.details).at("exit_code").is_null());
  CHECK(why.hint.empty());
}

namespace {

instance_spec example() {
  instance_spec x;
  x.instance = "t-s-00000001";
  x.task = "t";
  x.step = "s";
  x.operation = "echo";
  x.model = "plain";
  x.deployment = "cpu";
  x.cell = "kitchen";
  x.input = {{"file", "/in.txt", "text/plain"}};
  x.parameters = R"({"prefix":"> "})";
  return x;
}

} // namespace

TEST_CASE("an instance is told who it is, what it works on, and how") {
  const auto env = instance_environment(example(), {});
  CHECK(env.at("ROSCELL_TASK") == "t");
  CHECK(env.at("ROSCELL_STEP") == "s");
  CHECK(env.at("ROSCELL_INSTANCE") == "t-s-00000001");
  CHECK(env.at("ROSCELL_OPERATION") == "echo");
  CHECK(env.at("ROSCELL_MODEL") == "plain");
  CHECK(env.at("ROSCELL_DEPLOYMENT") == "cpu");
  CHECK(env.at("ROSCELL_CELL") == "kitchen");
  CHECK(env.at("WATCHDOG_USEC") == "8000000");
  CHECK(env.at("ROSCELL_PARAMETERS") == R"({"prefix":"> "})");
  CHECK(json::parse(env.at("ROSCELL_INPUTS"))
        == json::parse(R"([{"protocol":"file","endpoint":"/in.txt",
                            "data_type":"text/plain"}])"));
  CHECK(env.at("ROSCELL_OUTPUTS") == "[]");
  CHECK(env.count("ROSCELL_GPU") == 0);
}

TEST_CASE("what the node says of the cell counts more than what the spec "
          "says, and less than the contract") {
  auto spec = example();
  spec.environment = {{"ROS_DOMAIN_ID", "1"}, {"LEVEL", "2"}};
  const auto env = instance_environment(
      spec, {}, {{"ROS_DOMAIN_ID", "7"}, {"ROSCELL_TASK", "x"}});
  CHECK(env.at("ROS_DOMAIN_ID") == "7");
  CHECK(env.at("LEVEL") == "2");
  CHECK(env.at("ROSCELL_TASK") == "t");
}

TEST_CASE("a skill measures its streams only where somebody wants to know") {
  auto spec = example();
  CHECK(instance_environment(spec, {}).count("ROSCELL_HEALTH") == 0);
  spec.life.health.inputs.max_age_s = 1;
  CHECK(instance_environment(spec, {}).at("ROSCELL_HEALTH") == "1");
}

TEST_CASE("an instance without parameters gets an empty object") {
  auto spec = example();
  spec.parameters.clear();
  CHECK(instance_environment(spec, {}).at("ROSCELL_PARAMETERS") == "{}");
}

TEST_CASE("an instance with a GPU sees that GPU only") {
  auto spec = example();
  spec.gpu = 2;
  const auto env = instance_environment(spec, {});
  CHECK(env.at("ROSCELL_GPU") == "2");
  CHECK(env.at("CUDA_VISIBLE_DEVICES") == "2");
}

TEST_CASE("the spec's variables replace the deployment's, not the contract") {
  auto spec = example();
  deployment_option option;
  option.environment = {{"A", "deployment"}, {"B", "deployment"}};
  spec.environment = {{"B", "spec"}, {"ROSCELL_TASK", "forged"}};
  const auto env = instance_environment(spec, option);
  CHECK(env.at("A") == "deployment");
  CHECK(env.at("B") == "spec");
  CHECK(env.at("ROSCELL_TASK") == "t");
}

TEST_CASE("a program is told which of its parameters can be changed") {
  skill_descriptor skill;
  implementation_model model;
  model.name = "m";
  model.parameters = R"({"size": 4, "loop": {"type": "boolean"}})";
  skill.models = {model};
  CHECK(changeable_parameters(skill, "m").empty());
  skill.models[0].parameters =
      R"({"size": 4, "gain": {"type": "number", "changeable": true}})";
  CHECK(json::parse(changeable_parameters(skill, "m"))
        == json{{"gain", {{"type", "number"}, {"changeable", true}}}});
  CHECK(changeable_parameters(skill, "other").empty());
}
