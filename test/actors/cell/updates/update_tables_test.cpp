#include "actors/cell/limits.hpp"
#include "actors/cell/tables/task_table.hpp"
#include "actors/cell/updates/update_order.hpp"
#include "actors/cell/updates/update_plan.hpp"
#include "actors/cell/updates/update_table.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

/// What differs between a task and a request, in which order it is changed, and
/// how far that is.
namespace roscell::test {

namespace {

using namespace std::chrono_literals;
using time_point = update_table::time_point;

io_endpoint topic(const std::string& name) {
  return {"ros2", name, "std_msgs/msg/String", "", false};
}

io_endpoint file(const std::string& path) {
  return {"file", path, "image/png", "", false};
}

instance_spec spec(const std::string& step, std::vector<io_endpoint> input = {},
                   std::vector<io_endpoint> output = {}) {
  instance_spec result;
  result.instance = "t-" + step + "-1";
  result.task = "t";
  result.step = step;
  result.operation = "echo";
  result.model = "plain";
  result.deployment = "cpu";
  result.skill = "aa";
  result.input = std::move(input);
  result.output = std::move(output);
  result.parameters = "{}";
  return result;
}

resolved_step step(const std::string& id, const std::string& build = "aa",
                   std::vector<std::string> nodes = {"left", "right"}) {
  resolved_step result;
  result.step.id = id;
  result.step.operation = "echo";
  result.step.model = "plain";
  skill_build candidate;
  candidate.hash = build;
  candidate.model.name = "plain";
  candidate.model.parameters = "{}";
  candidate.model.deployments.emplace_back();
  candidate.model.deployments.back().name = "cpu";
  candidate.nodes = std::move(nodes);
  result.builds = {candidate};
  return result;
}

update_question question(std::vector<resolved_step> steps) {
  update_question result;
  for (const auto* id : {"a", "b"})
    result.placed.push_back({spec(id), "left", std::nullopt, false});
  result.steps = std::move(steps);
  return result;
}

step_action action_of(const update_plan& plan, const std::string& id) {
  for (const auto& x : plan.changes())
    if (x.step == id)
      return x.action;
  FAIL("no step " + id);
  return {};
}

replaced_step replaced(const instance_spec& old, const instance_spec& fresh,
                       size_t rank) {
  replaced_step result;
  result.old = old;
  result.fresh = fresh;
  result.old_node = result.fresh_node = "left";
  result.rank = rank;
  return result;
}

using waves = std::vector<std::vector<size_t>>;

} // namespace

TEST_CASE("steps are told apart by what they are, not by who feeds them",
          "[update_tables]") {
  auto asked = question({step("a"), step("b")});
  asked.placed[1].spec.input = {topic("/x")};
  asked.placed[1].spec.input[0].from = "someone";
  asked.steps[1].step.input = {topic("/x")};
  CHECK(compare_steps(asked).is_empty());
  asked.steps[1].step.input = {topic("/y")};
  const auto plan = compare_steps(asked);
  CHECK(action_of(plan, "a") == step_action::stays);
  CHECK(action_of(plan, "b") == step_action::restarts);
  CHECK(plan.steps[1].change.reasons
        == std::vector<std::string>{"input.endpoint: /x -> /y"});
}

TEST_CASE("what the cell adds to an environment changes no step, and what a "
          "step has there is not shown",
          "[update_tables]") {
  auto asked = question({step("a"), step("b")});
  asked.placed[0].spec.environment = {{"OF_CELL", "1"}};
  CHECK_FALSE(compare_steps(asked).is_empty());
  asked.cell_environment = {"OF_CELL"};
  CHECK(compare_steps(asked).is_empty());
  asked.steps[0].step.env = {{"KEY", "secret"}};
  CHECK(compare_steps(asked).steps[0].change.reasons
        == std::vector<std::string>{"environment.KEY"});
}

TEST_CASE("a step that names another secret is changed",
          "[update_tables][secrets]") {
  auto asked = question({step("a"), step("b")});
  asked.placed[0].spec.secrets = {"key"};
  asked.placed[0].spec.secret_env = {{"PASSWORD", "pass"}};
  asked.steps[0].step.secrets = {"key"};
  asked.steps[0].step.secret_env = {{"PASSWORD", "pass"}};
  CHECK(compare_steps(asked).is_empty());
  asked.steps[0].step.secret_env = {{"PASSWORD", "pass2"}};
  auto plan = compare_steps(asked);
  CHECK(action_of(plan, "a") == step_action::restarts);
  CHECK(action_of(plan, "b") == step_action::stays);
  asked.steps[0].step.secret_env = {{"PASSWORD", "pass"}};
  asked.steps[0].step.secrets = {"key", "other"};
  CHECK(action_of(compare_steps(asked), "a") == step_action::restarts);
}

TEST_CASE("a newer build changes a step, and one that is not there moves it",
          "[update_tables]") {
  auto plan = compare_steps(question({step("a", "bb"), step("b")}));
  CHECK(action_of(plan, "a") == step_action::restarts);
  CHECK(plan.steps[0].change.reasons
        == std::vector<std::string>{"build: aa -> bb"});
  plan = compare_steps(question({step("a", "aa", {"right"}), step("b")}));
  CHECK(action_of(plan, "a") == step_action::moves);
}

TEST_CASE("a step on a node that is away stays unless it is written otherwise",
          "[update_tables]") {
  auto asked = question({step("a", "aa", {"right"}), step("b", "bb", {})});
  asked.away = {"left"};
  CHECK(compare_steps(asked).is_empty());
  asked.steps[0].step.arguments = {"-v"};
  CHECK(action_of(compare_steps(asked), "a") == step_action::restarts);
}

TEST_CASE("a label that the node of a step does not have moves it",
          "[update_tables]") {
  auto asked = question({step("a"), step("b")});
  asked.labels["left"] = {{"room", "lab"}};
  asked.steps[0].step.labels = {{"room", "lab"}};
  CHECK(compare_steps(asked).is_empty());
  asked.steps[0].step.labels = {{"room", "hall"}};
  CHECK(action_of(compare_steps(asked), "a") == step_action::moves);
}

TEST_CASE("steps that share files with one that stays stay with it",
          "[update_tables]") {
  auto asked = question({step("a", "bb"), step("b")});
  asked.steps[0].together = asked.steps[1].together = 1;
  const auto plan = compare_steps(asked);
  CHECK(plan.steps[0].step.builds[0].nodes == std::vector<std::string>{"left"});
  asked.restart_all = true;
  CHECK(compare_steps(asked).steps[0].step.builds[0].nodes.size() == 2);
}

TEST_CASE("reasons are bounded", "[update_tables]") {
  auto asked = question({step("a"), step("b")});
  for (int i = 0; i < 100; ++i)
    asked.steps[0].step.env["V" + std::to_string(i)] = "1";
  asked.steps[1].step.arguments = {std::string(1000, 'x')};
  const auto plan = compare_steps(asked);
  CHECK(plan.steps[0].change.reasons.size() == 9);
  CHECK(plan.steps[0].change.reasons.back() == "and 92 more");
  CHECK(plan.steps[1].change.reasons[0].size() < 100);
}

TEST_CASE("steps are replaced one after the other, upstream first",
          "[update_tables]") {
  const auto sink = spec("sink", {topic("/x")});
  const auto source = spec("source", {}, {topic("/x")});
  CHECK(update_waves({replaced(sink, sink, 1), replaced(source, source, 0)})
        == waves{{1}, {0}});
}

TEST_CASE("a topic, file or device that passes to another step has one user",
          "[update_tables]") {
  const auto none = spec("n");
  for (const auto& end : {topic("/x"), file("/srv/x")}) {
    const auto writes = spec("w", {}, {end});
    CHECK(update_waves({replaced(none, writes, 0), replaced(writes, none, 1)})
          == waves{{0, 1}});
  }
  const auto reads = spec("r", {{"video", "/dev/video0", "", "", false}});
  CHECK(update_waves({replaced(none, reads, 0), replaced(reads, none, 1)})
        == waves{{0, 1}});
  // Files of two nodes are two.
  const auto writes = spec("w", {}, {file("/srv/x")});
  auto elsewhere = replaced(none, writes, 0);
  elsewhere.fresh_node = "right";
  CHECK(update_waves({elsewhere, replaced(writes, none, 1)})
        == waves{{0}, {1}});
}

TEST_CASE("what only ends comes last, unless another needs what it has",
          "[update_tables]") {
  replaced_step ends;
  ends.old = spec("old", {}, {topic("/y")});
  ends.old_node = "left";
  const auto x = spec("x");
  CHECK(update_waves({ends, replaced(x, x, 0)}) == waves{{1}, {0}});
  auto hungry = replaced(x, x, 0);
  hungry.needs_room = true;
  CHECK(update_waves({ends, hungry}) == waves{{0, 1}});
  const auto y = spec("x", {}, {topic("y")});
  CHECK(update_waves({ends, replaced(x, y, 0)}) == waves{{0, 1}});
}

TEST_CASE("an update goes from wave to wave and ends once", "[update_tables]") {
  update_table table;
  const time_point now{};
  const auto id = table.begin("t", "body");
  CHECK(table.is_updating("t"));
  CHECK_FALSE(table.is_updating("u"));
  CHECK(table.find_plan("t", "body") == nullptr);
  table.plan(id, {"t"}, 2);
  CHECK(table.find_plan("t", "body") != nullptr);
  CHECK(table.find_plan("t", "other") == nullptr);
  CHECK(table.open_wave(id) == size_t{0});
  CHECK(table.text("t") == "part 1 of 2: its builds are fetched");
  CHECK(table.enter(id, update_stage::ending));
  CHECK(table.text("t") == "part 1 of 2: what is replaced ends");
  CHECK(table.enter(id, update_stage::starting));
  table.settle(id, {"t-a-1"}, now + 10s);
  CHECK(table.next_due() == now + 10s);
  CHECK(table.watching("t-a-1") == id);
  CHECK(table.watching("t-b-1") == 0);
  CHECK(table.take_settled(now + 9s).empty());
  CHECK(table.take_settled(now + 10s) == std::vector<uint64_t>{id});
  CHECK(table.next_due() == time_point::max());
  CHECK(table.open_wave(id) == size_t{1});
  CHECK(table.watching("t-a-1") == id);
  table.settle(id, {}, now + 20s);
  CHECK_FALSE(table.open_wave(id));
  CHECK(table.enter(id, update_stage::undone));
  CHECK_FALSE(table.enter(id, update_stage::written));
  CHECK(table.watching("t-a-1") == 0);
  table.end(id);
  CHECK_FALSE(table.has(id));
  CHECK_FALSE(table.enter(id, update_stage::ending));
  CHECK(table.size() == 0);
}

TEST_CASE("former requests are kept within a number and bytes",
          "[update_tables]") {
  revision_history history;
  for (int i = 0; i < 10; ++i)
    revise(history, "request " + std::to_string(i), {}, i + 1);
  CHECK(history.revision == 11);
  REQUIRE(history.former.size() == limits::task::former_requests);
  CHECK(history.former.back().request == "request 9");
  CHECK(history.former.back().revision == 10);
  revise(history, std::string(limits::task::former_request_bytes - 10, 'x'), {},
         20);
  CHECK(history.former.size() == 2);
  revise(history, std::string(limits::task::former_request_bytes + 1, 'x'), {},
         30);
  CHECK(history.former.empty());
  CHECK(history.revision == 13);
}

} // namespace roscell::test
