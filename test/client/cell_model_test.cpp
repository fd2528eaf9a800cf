#include "client/cell_model.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

instance_row running_row(const std::string& id, const std::string& node) {
  instance_row row;
  row.spec.instance = id;
  row.spec.task = "t";
  row.spec.step = "a";
  row.node = node;
  row.state = instance_state::running;
  row.since_unix_ms = 1000;
  return row;
}

registry_row active_row(const std::string& name) {
  registry_row row;
  row.identity.name = name;
  row.identity.uuid = "u-" + name;
  row.state = row_state::active;
  return row;
}

cell_description cell_of_two() {
  cell_description cell;
  cell.cell = "line";
  cell.nodes = {active_row("head"), active_row("arm")};
  cell.tasks = {{"t", task_state::running, 1000, 0, {running_row("i", "arm")}}};
  return cell;
}

node_description coordinator() {
  node_description node;
  node.role = node_role::coordinator;
  node.identity.uuid = "u-head";
  return node;
}

cell_model begun_model() {
  cell_model result;
  result.open({}, 500);
  result.set_cell(coordinator(), cell_of_two());
  return result;
}

event changed(const std::string& data) {
  return {7, 5000, "instance_changed", "i", data};
}

const instance_row& only_row(const cell_model& x) {
  REQUIRE(x.known().instances.size() == 1);
  return x.known().instances.front();
}

} // namespace

TEST_CASE("an event changes the state of an instance at once", "[client]") {
  auto x = begun_model();
  const auto asks =
      x.add(changed(R"({"task":"t","node":"arm","state":"backing_off",)"
                    R"("reason":"it ended with exit code 7","restarts":3})"));
  CHECK(only_row(x).state == instance_state::backing_off);
  CHECK(only_row(x).since_unix_ms == 5000);
  CHECK(only_row(x).restarts == 3);
  CHECK(only_row(x).reason == "it ended with exit code 7");
  CHECK(x.known().cell.tasks.front().instances.front().state
        == instance_state::backing_off);
  // The task's own state follows from it.
  CHECK(asks.cell);
}

TEST_CASE("what a coordinator will tell again with the node is skipped",
          "[client]") {
  auto x = begun_model();
  x.add(changed(R"({"task":"t","state":"failed"})"));
  CHECK(only_row(x).state == instance_state::running);
}

TEST_CASE("a state of a newer version, or data that are none, change nothing",
          "[client]") {
  auto x = begun_model();
  x.add(changed(R"({"node":"arm","state":"dreaming"})"));
  x.add(changed("none"));
  CHECK(only_row(x).state == instance_state::running);
}

TEST_CASE("a lost node is shown as lost at once, with what it ran",
          "[client]") {
  auto x = begun_model();
  auto reported = running_row("i", "arm");
  reported.metrics = {7, 2.5, 0, 1.5};
  x.set_metrics({reported});
  CHECK(only_row(x).metrics.rate_hz == 2.5);
  const auto asks =
      x.add({8, 6000, "node_lost", "arm", R"({"reason":"no heartbeats"})"});
  CHECK(x.known().cell.nodes.back().state == row_state::lost);
  CHECK(x.known().cell.nodes.back().reason == "no heartbeats");
  CHECK(only_row(x).unknown_since_unix_ms == 6000);
  CHECK(only_row(x).metrics.rate_hz < 0);
  CHECK(asks.cell);
  CHECK(asks.skills);
  CHECK(problems_of(x.known(), 8000).front()
        == "node arm lost 2s: no heartbeats");
}

TEST_CASE("metrics outlive the next answer about the cell", "[client]") {
  auto x = begun_model();
  auto reported = running_row("i", "arm");
  reported.metrics.rate_hz = 29.9;
  x.set_metrics({reported});
  x.set_cell(coordinator(), cell_of_two());
  CHECK(only_row(x).metrics.rate_hz == 29.9);
}

TEST_CASE("only events after which the cell is another one ask for it",
          "[client]") {
  auto x = begun_model();
  CHECK_FALSE(x.add({1, 0, "request_refused", "task_request", ""}).any());
  CHECK_FALSE(x.add({2, 0, "image_building", "i", ""}).any());
  CHECK(x.add({3, 0, "task_accepted", "t", ""}).cell);
  CHECK(x.add({4, 0, "node_joined", "n", ""}).skills);
  CHECK_FALSE(x.add({5, 0, "task_accepted", "t", ""}).skills);
}

TEST_CASE("of the events that fit one the first entry counts", "[client]") {
  using answers = std::vector<std::string>;
  CHECK(stale_after("node_joined") == answers{"cell", "cells", "skills"});
  CHECK(stale_after("node_renamed") == answers{"cell"});
  CHECK(stale_after("task_finished") == answers{"task"});
  CHECK(stale_after("image_building").empty());
}

TEST_CASE("what was known stays when the node is away, since when it is",
          "[client]") {
  auto x = begun_model();
  x.lose("cannot connect", 2000);
  x.lose("still not", 3000);
  CHECK_FALSE(x.connection().live);
  CHECK(x.connection().since_unix_ms == 2000);
  CHECK(x.connection().problem == "still not");
  CHECK(x.known().cell.nodes.size() == 2);
  x.open({}, 4000);
  CHECK(x.connection().live);
  CHECK(x.connection().problem.empty());
}

TEST_CASE("a question without an answer is told until one is answered",
          "[client]") {
  auto x = begun_model();
  x.miss("no answer in time");
  CHECK(x.connection().live);
  CHECK(x.connection().problem == "no answer in time");
  x.set_cell(coordinator(), cell_of_two());
  CHECK(x.connection().problem.empty());
}

TEST_CASE("the newest events are kept, and no more than that", "[client]") {
  cell_model x;
  std::vector<event> kept(cell_model::most_events + 5);
  kept.back().sequence = 42;
  x.open(std::move(kept), 0);
  CHECK(x.known().events.size() == cell_model::most_events);
  for (uint64_t i = 0; i < 3 * cell_model::most_events; ++i)
    x.add({i, 0, "store_failed", "", ""});
  CHECK(x.known().events.size() <= cell_model::most_events);
  CHECK(x.known().events.back().sequence == 3 * cell_model::most_events - 1);
}

TEST_CASE("a cell in which all runs has no problems", "[client]") {
  CHECK(problems_of(begun_model().known(), 9000).empty());
}

TEST_CASE("an instance that does not run well is a problem with its reason",
          "[client]") {
  auto x = begun_model();
  x.add(changed(R"({"node":"arm","state":"failed","reason":"exit code 7"})"));
  const auto problems = problems_of(x.known(), 9000);
  REQUIRE(problems.size() == 1);
  CHECK(problems.front() == "t/a failed: exit code 7");
}
