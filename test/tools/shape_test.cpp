#include "tools/roscell/view/views.hpp"

#include "messages/cell.hpp"
#include "messages/formation.hpp"
#include "messages/skill.hpp"
#include "test/places.hpp"
#include "test/schemas/oracle.hpp"

#include <catch2/catch.hpp>

#include <fstream>

namespace roscell::cli {

namespace {

json schema_of(const std::string& name) {
  std::ifstream file{test::source_dir() / "docs/output"
                     / (name + ".schema.json")};
  return json::parse(file);
}

instance_row shaped_instance() {
  instance_row result;
  result.spec.instance = "t-say-1a2b3c4d";
  result.spec.task = "t";
  result.spec.step = "say";
  result.spec.operation = "echo";
  result.spec.model = "plain";
  result.spec.deployment = "cpu";
  result.spec.input = {{"file", "/tmp/in", "text/plain", "", false}};
  result.spec.parameters = R"({"prefix": "", "start_unix_ms": 5})";
  result.node = "arm-1";
  result.state = instance_state::running;
  result.since_unix_ms = 1'700'000'000'123;
  return result;
}

cell_description sample_cell() {
  cell_description result;
  result.cell = "lab";
  result.nodes.resize(1);
  result.nodes[0].identity = {"arm-1", "u", 1, "10.0.0.1:8420"};
  result.nodes[0].instances = {shaped_instance()};
  result.free = {{"arm-2", "v", "10.0.0.2:8420", node_state::independent, ""}};
  return result;
}

void check(const std::string& schema, const json& list) {
  INFO(list.dump(2));
  CHECK_FALSE(list.empty());
  CHECK(test::oracle_accepts(schema_of(schema), list));
}

} // namespace

TEST_CASE("what is printed as JSON follows its published schema", "[tools]") {
  check("nodes", shaped_list(message_json(sample_cell()), {"nodes", "free"}));
  check("instances",
        shaped_list(message_json(instance_description{{shaped_instance()}}),
                    {"instances"}));
  check("tasks",
        shaped_list(message_json(task_description{{task_row{
                        "t", task_state::running, 5, 0, {shaped_instance()}}}}),
                    {"tasks"}));
  check(
      "cells",
      shaped_list(message_json(cell_list{{{"lab", "arm-1", "a", "b", 3, ""}}}),
                  {"cells"}));
  skill_row skill;
  skill.skill.descriptor.operation = "echo";
  skill.nodes = {"arm-1"};
  skill.added_unix_ms = {7};
  check("skills",
        shaped_list(message_json(skill_list{{skill}, {}}), {"skills"}));
  transfer_row transfer;
  transfer.transfer = "lab-1-1";
  check("transfers", shaped_list(message_json(transfer_description{{transfer}}),
                                 {"transfers"}));
}

TEST_CASE("a thing has its name and shape wherever it stands", "[tools]") {
  const auto row = shaped(json(shaped_instance()));
  CHECK(row["name"] == "t-say-1a2b3c4d");
  CHECK(row["since"] == "2023-11-14T22:13:20.123Z");
  CHECK(row["spec"]["input"].is_array());
  const auto cell = shaped_list(message_json(sample_cell()), {"nodes", "free"});
  CHECK(cell[0]["name"] == "arm-1");
  CHECK(cell[1]["name"] == "arm-2");
  CHECK(cell[0]["instances"][0] == row);
}

TEST_CASE("a time that is not known is null, and parameters stay theirs",
          "[tools]") {
  auto instance = shaped_instance();
  instance.since_unix_ms = 0;
  const auto row = shaped(json(instance));
  CHECK(row["since"].is_null());
  CHECK(row["spec"]["parameters"]["start_unix_ms"] == 5);
}

} // namespace roscell::cli
