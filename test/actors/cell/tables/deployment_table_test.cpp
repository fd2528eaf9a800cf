#include "actors/cell/limits.hpp"
#include "actors/cell/tables/deployment_table.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

instance_spec spec_of(const std::string& instance, const std::string& task) {
  instance_spec result;
  result.instance = instance;
  result.task = task;
  result.step = "s";
  result.parameters = "{}";
  return result;
}

instance_row reported(const std::string& instance, const std::string& task,
                      instance_state state = instance_state::running) {
  instance_row result;
  result.spec = spec_of(instance, task);
  result.state = state;
  return result;
}

deployment on(const std::string& node, const std::string& instance,
              const std::string& task) {
  return {spec_of(instance, task), node, std::nullopt, false};
}

deployment ended_on(const std::string& node, const std::string& instance,
                    const std::string& task) {
  auto result = on(node, instance, task);
  result.end = instance_end{instance, instance_state::stopped, 0, "", 5};
  return result;
}

} // namespace

TEST_CASE("An instance is found on the node of its placement only",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), on("b", "t-1", "t")});
  CHECK(table.find("t-0", "a"));
  CHECK_FALSE(table.find("t-0", "b"));
  CHECK(table.find("t-1"));
  CHECK_FALSE(table.find("t-2"));
}

TEST_CASE("What has ended is not bound to its node", "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), ended_on("a", "t-1", "t")});
  table.place("u", {ended_on("a", "u-0", "u"), on("b", "u-1", "u")});
  REQUIRE(table.bound_to("a").size() == 1);
  CHECK(table.bound_to("a")[0].instance == "t-0");
  CHECK(table.tasks_bound_to("a") == std::vector<std::string>{"t"});
  CHECK(table.tasks_bound_to("b") == std::vector<std::string>{"u"});
}

TEST_CASE("Room is held for what a node has not told of",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                    ended_on("a", "t-2", "t")});
  CHECK(table.untold_on("a").size() == 2);
  table.note_row("a", reported("t-0", "t", instance_state::starting));
  REQUIRE(table.untold_on("a").size() == 1);
  CHECK(table.untold_on("a")[0].instance == "t-1");
  // Another node cannot take it off.
  table.note_row("b", reported("t-1", "t"));
  CHECK(table.untold_on("a").size() == 1);
}

TEST_CASE("A node's word changes rows of that node only",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t")});
  table.note_row("a", reported("t-0", "t"));
  table.note_row("b", reported("t-0", "t", instance_state::failed));
  table.forget_reported("b", "t-0");
  CHECK(table.find_row("t-0")->state == instance_state::running);
  CHECK(table.find_row("t-0")->node == "a");
  CHECK(table.untaken_ends("t").empty());
}

TEST_CASE("An end that its node has told of is to be written down once",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t")});
  auto row = reported("t-0", "t", instance_state::failed);
  row.exit_code = 3;
  row.reason = "it exited with code 3";
  table.note_row("a", row);
  const auto ends = table.untaken_ends("t");
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].exit_code == 3);
  auto placed = on("a", "t-0", "t");
  placed.end = ends[0];
  table.place("t", {placed});
  CHECK(table.untaken_ends("t").empty());
  // It stays known when the node forgets it.
  table.forget_node("a");
  CHECK(table.find_row("t-0")->exit_code == 3);
  CHECK(table.find_row("t-0")->state == instance_state::failed);
}

TEST_CASE("A node that registers replaces all that it has told",
          "[deployment_table]") {
  deployment_table table;
  table.note_row("a", reported("x", "t"));
  table.note_all_rows("a", {reported("y", "t"), reported("z", "t")});
  CHECK(table.rows_on("a").size() == 2);
  CHECK_FALSE(table.reported("a", "x"));
}

TEST_CASE("Rows of what no task has placed are known too",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                    ended_on("a", "t-2", "t")});
  table.note_row("a", reported("t-0", "t"));
  table.note_row("a", reported("stray", "nobody's"));
  CHECK(table.known_on("a", false).size() == 3);
  CHECK(table.known_on("a", true).size() == 4);
  CHECK(table.find_row("stray"));
}

TEST_CASE("A node's words replace those that it told before",
          "[deployment_table]") {
  deployment_table table;
  auto building = reported("x", "t");
  building.status = "step 3 of 7";
  building.metrics.frames = 1;
  auto ended = reported("y", "t", instance_state::stopped);
  ended.metrics.frames = 9;
  table.note_all_rows("a", {building, ended, reported("z", "t")});
  instance_metrics metrics;
  metrics.frames = 5;
  table.note_status_texts("a", {{"y", "", metrics},
                                {"z", "frames=5", metrics},
                                {"unknown", "", metrics}});
  table.note_status_texts("nobody", {{"z", "", {}}});
  CHECK(table.reported("a", "x")->metrics == instance_metrics{});
  CHECK(table.reported("a", "x")->status == "step 3 of 7");
  CHECK(table.reported("a", "y")->metrics.frames == 9);
  CHECK(table.reported("a", "z")->metrics.frames == 5);
  CHECK(table.reported("a", "z")->status == "frames=5");
  CHECK_FALSE(table.reported("a", "unknown"));
  CHECK_FALSE(table.reported("nobody", "z"));
}

TEST_CASE("Measures are those of the rows that are known",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                    ended_on("a", "t-2", "t"), on("b", "t-3", "t")});
  auto row = reported("t-0", "t");
  row.restarts = 2;
  row.metrics.frames = 7;
  table.note_row("a", row);
  table.note_row("a", reported("stray", "nobody's", instance_state::stopped));
  for (const bool untold : {false, true}) {
    const auto rows = table.known_on("a", untold);
    const auto measures = table.measures_on("a", untold);
    REQUIRE(measures.size() == rows.size());
    for (size_t i = 0; i < rows.size(); ++i)
      CHECK(measures[i] == measures_of(rows[i]));
  }
  CHECK(table.nodes_with_live() == std::set<std::string>{"a"});
  table.forget_node("a");
  CHECK(table.nodes_with_live().empty());
}

TEST_CASE("A task that is forgotten takes along what was told of it",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t")});
  table.note_row("a", reported("t-0", "t"));
  table.forget_task("t");
  CHECK(table.known_on("a", true).empty());
  CHECK_FALSE(table.find("t-0"));
}

TEST_CASE("What has ended and is placed no more is forgotten",
          "[deployment_table]") {
  deployment_table table;
  table.place("t", {on("a", "t-0", "t"), on("b", "t-1", "t")});
  table.note_row("a", reported("t-0", "t"));
  table.note_row("b", reported("t-1", "t", instance_state::failed));
  // A move to b is undone; a runs on, until it says otherwise.
  table.place("t", {});
  CHECK(table.rows_on("a").size() == 1);
  CHECK(table.rows_on("b").empty());
}

TEST_CASE("What one node tells is bounded", "[deployment_table]") {
  deployment_table table;
  for (size_t i = 0; i < limits::instance::reported; ++i)
    CHECK(table.note_row("a", reported("i" + std::to_string(i), "t")));
  CHECK_FALSE(table.note_row("a", reported("one-more", "t")));
  CHECK(table.note_row("a", reported("i0", "t", instance_state::failed)));
  CHECK(table.note_row("b", reported("one-more", "t")));
}

} // namespace roscell::test
