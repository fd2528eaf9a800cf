#include "tools/roscell/view/describe/describe_view.hpp"

#include "test/printed_text.hpp"
#include "test/words.hpp"
#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/describe/page.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

known_cell described_sample() {
  known_cell known;
  known.cell.cell = "lab";
  known.cell.coordinator = "head";
  registry_row node;
  node.identity = {"arm-1", "u-1", 3, "10.0.0.1:8420"};
  node.state = row_state::active;
  node.since_unix_ms = 1000;
  node.resources.labels = {{"room", "hall"}};
  node.resources.devices = {"/dev/video0"};
  node.resources.cpu = {4, 0.5};
  known.cell.nodes = {node};
  instance_row row;
  row.spec.instance = "t-poses-1a2b3c4d";
  row.spec.task = "t";
  row.spec.step = "poses";
  row.spec.input = {{"ros2", "/image", "sensor_msgs/msg/Image"}};
  row.spec.parameters = R"({"tag_size_m":0.16})";
  row.node = "arm-1";
  row.state = instance_state::running;
  row.since_unix_ms = 2000;
  row.status = "frames=7";
  row.metrics = {7, 2.5, 0, 1.5};
  known.instances = {row};
  known.cell.tasks = {{"t", task_state::running, 1000, 0, {row}}};
  skill_row skill;
  skill.skill.hash = "0123456789abcdef";
  skill.skill.descriptor.operation = "poses";
  skill.skill.descriptor.models = {
      {"apriltag3",
       R"({"refine":{"type":"boolean","default":true,"description":"finer"},)"
       R"("rate_hz":{"type":"number","minimum":1,"maximum":30,"unit":"Hz"}})",
       {deployment_option{}}}};
  skill.nodes = {"arm-1"};
  known.skills.skills = {skill};
  known.events = {{1, 1000, "node_joined", "arm-1", ""},
                  {2, 1500, "allocation_chosen", "t",
                   R"({"allocations":[{"step":"poses","node":"arm-1"}],)"
                   R"("score":{"total":0.25}})"},
                  {3, 2000, "instance_changed", "t-poses-1a2b3c4d",
                   R"({"task":"t","node":"arm-1","state":"running"})"}};
  return known;
}

std::string described(const known_cell& known, const std::string& name,
                      const std::string& kind = {}) {
  return describe_view(known, find_thing(known, kind, name), "a line\n",
                       {{}, 61'000});
}

using roscell::test::has;

std::string refusal(const known_cell& known, const std::string& name,
                    const std::string& kind = {}) {
  try {
    find_thing(known, kind, name);
  } catch (const command_error& e) {
    return e.what() + (" | " + e.hint);
  }
  return {};
}

} // namespace

TEST_CASE("a node is described with all that it has and runs", "[tools]") {
  const auto text = described(described_sample(), "arm-1");
  CHECK(has(text, "Kind:           node\n"));
  CHECK(has(text, "Name:           arm-1\n"));
  CHECK(has(text, "Labels:         room=hall\n"));
  CHECK(has(text, "Devices:        /dev/video0\n"));
  CHECK(has(text, "Skills:         poses\n"));
  CHECK(has(text, "\nResources:\n  RESOURCE "));
  CHECK(has(roscell::test::cells_in(text),
            "t-poses-1a2b3c4d|poses|arm-1|running|59s|2.5 Hz|0|1.5 ms\n"));
  CHECK(has(text, "node_joined"));
  CHECK(has(text, "instance_changed"));
  CHECK_FALSE(has(text, "allocation_chosen"));
}

TEST_CASE("a task is described with its steps, ports and allocation",
          "[tools]") {
  const auto text = described(described_sample(), "t");
  CHECK(has(text, "Allocation:     poses→arm-1 score=0.25\n"));
  CHECK(has(text, "  in    /image    ros2      sensor_msgs/msg/Image\n"));
  CHECK(has(text, "  tag_size_m  0.16\n"));
}

TEST_CASE("an instance is described with its words, metrics and log",
          "[tools]") {
  const auto text = described(described_sample(), "t-poses-1a2b3c4d");
  CHECK(has(text, "Status text:    frames=7\n"));
  CHECK(has(text, "Metrics:        2.5 Hz, 0 dropped, 1.5 ms\n"));
  CHECK(has(text, "\nEnd of the log:\n  a line\n"));
}

TEST_CASE("an instance's health and safety are described", "[tools]") {
  auto known = described_sample();
  auto& row = known.instances[0];
  CHECK_FALSE(has(described(known, "t-poses-1a2b3c4d"), "Stop-safe"));
  row.health = instance_health::starved;
  row.health_reason = "input '/image' comes at 2 Hz";
  row.spec.life.safe_state = true;
  row.safe = safe_word::unsafe;
  const auto text = described(known, "t-poses-1a2b3c4d");
  CHECK(has(text, "running, starved since 59s"));
  CHECK(has(text, "input '/image' comes at 2 Hz"));
  CHECK(has(text, "Stop-safe"));
  row.safe = safe_word::untold;
  CHECK(
      has(described(known, "t-poses-1a2b3c4d"), "no, it has said nothing yet"));
}

TEST_CASE("a lost node's instance is described as unknown", "[tools]") {
  auto known = described_sample();
  known.instances[0].unknown_since_unix_ms = 31'000;
  const auto text = described(known, "t-poses-1a2b3c4d");
  CHECK(has(text, "State:          unknown since 30s, it was running\n"));
}

TEST_CASE("a declared parameter is described with its meaning", "[tools]") {
  const auto text = described(described_sample(), "poses");
  CHECK(has(text, "rate_hz, a number from 1 to 30 (Hz)\n"));
  CHECK(has(text, "refine: true, true or false\n"));
  CHECK(has(text, "      finer\n"));
}

TEST_CASE("a cell is described with its nodes and tasks", "[tools]") {
  const auto text = described(described_sample(), "lab");
  CHECK(has(text, "Coordinator:    head\n"));
  CHECK(has(text, "\nNodes:\n  NODE "));
  CHECK(has(text, "\nTasks:\n  TASK "));
}

TEST_CASE("a thing is found by the beginning of an instance's id", "[tools]") {
  CHECK(find_thing(described_sample(), "", "t-po").name == "t-poses-1a2b3c4d");
  CHECK(find_thing(described_sample(), "instance", "t").name
        == "t-poses-1a2b3c4d");
}

TEST_CASE("an unknown name is refused with the nearest one", "[tools]") {
  CHECK(refusal(described_sample(), "arm-2", "node")
        == "there is no node 'arm-2' | did you mean 'arm-1'?");
  CHECK(refusal(described_sample(), "labb")
        == "there is no node, task, instance, skill or cell 'labb' | did you "
           "mean 'lab'?");
}

TEST_CASE("a name that several things have needs a kind", "[tools]") {
  auto known = described_sample();
  known.cell.cell = "arm-1";
  CHECK(refusal(known, "arm-1")
        == "several things are called 'arm-1' | say which one: cell arm-1, "
           "node arm-1");
  CHECK(find_thing(known, "cell", "arm-1").kind == thing_kind::cell);
}

TEST_CASE("a description is told to programs too", "[tools]") {
  const auto known = described_sample();
  const auto x = describe_json(known, find_thing(known, "task", "t"), "");
  CHECK(x.at("kind") == "task");
  CHECK(x.at("name") == "t");
  CHECK(x.at("about").at("instances").at(0).at("figures").at("frames") == 7);
  CHECK(x.at("events").size() == 2);
}
