#include "actors/instances/life/instance_environment.hpp"

#include "messages/codec/json_codec.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

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
