#include "actors/cell/books/deployment_book.hpp"
#include "actors/house/limits.hpp"

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

instance_row told(const std::string& instance, const std::string& task,
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
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), on("b", "t-1", "t")});
  CHECK(book.find("t-0", "a"));
  CHECK_FALSE(book.find("t-0", "b"));
  CHECK(book.find("t-1"));
  CHECK_FALSE(book.find("t-2"));
}

TEST_CASE("What has ended is not bound to its node", "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), ended_on("a", "t-1", "t")});
  book.place("u", {ended_on("a", "u-0", "u"), on("b", "u-1", "u")});
  REQUIRE(book.bound_to("a").size() == 1);
  CHECK(book.bound_to("a")[0].instance == "t-0");
  CHECK(book.tasks_bound_to("a") == std::vector<std::string>{"t"});
  CHECK(book.tasks_bound_to("b") == std::vector<std::string>{"u"});
}

TEST_CASE("Room is held for what a node has not told of", "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                   ended_on("a", "t-2", "t")});
  CHECK(book.untold_on("a").size() == 2);
  book.tell("a", told("t-0", "t", instance_state::starting));
  REQUIRE(book.untold_on("a").size() == 1);
  CHECK(book.untold_on("a")[0].instance == "t-1");
  // Another node cannot take it off.
  book.tell("b", told("t-1", "t"));
  CHECK(book.untold_on("a").size() == 1);
}

TEST_CASE("A node's word changes rows of that node only", "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t")});
  book.tell("a", told("t-0", "t"));
  book.tell("b", told("t-0", "t", instance_state::failed));
  book.forget_told("b", "t-0");
  CHECK(book.find_row("t-0")->state == instance_state::running);
  CHECK(book.find_row("t-0")->node == "a");
  CHECK(book.untaken_ends("t").empty());
}

TEST_CASE("An end that its node has told of is to be written down once",
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t")});
  auto row = told("t-0", "t", instance_state::failed);
  row.exit_code = 3;
  row.reason = "it exited with code 3";
  book.tell("a", row);
  const auto ends = book.untaken_ends("t");
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].exit_code == 3);
  auto placed = on("a", "t-0", "t");
  placed.end = ends[0];
  book.place("t", {placed});
  CHECK(book.untaken_ends("t").empty());
  // It stays known when the node forgets it.
  book.forget_node("a");
  CHECK(book.find_row("t-0")->exit_code == 3);
  CHECK(book.find_row("t-0")->state == instance_state::failed);
}

TEST_CASE("A node that registers replaces all that it has told",
          "[deployment_book]") {
  deployment_book book;
  book.tell("a", told("x", "t"));
  book.tell_all("a", {told("y", "t"), told("z", "t")});
  CHECK(book.rows_on("a").size() == 2);
  CHECK_FALSE(book.told("a", "x"));
}

TEST_CASE("Rows of what no task has placed are known too",
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                   ended_on("a", "t-2", "t")});
  book.tell("a", told("t-0", "t"));
  book.tell("a", told("stray", "nobody's"));
  CHECK(book.known_on("a", false).size() == 3);
  CHECK(book.known_on("a", true).size() == 4);
  CHECK(book.find_row("stray"));
}

TEST_CASE("A node's words replace those that it told before",
          "[deployment_book]") {
  deployment_book book;
  auto building = told("x", "t");
  building.status = "step 3 of 7";
  building.figures.frames = 1;
  auto ended = told("y", "t", instance_state::stopped);
  ended.figures.frames = 9;
  book.tell_all("a", {building, ended, told("z", "t")});
  instance_figures figures;
  figures.frames = 5;
  book.tell_words("a", {{"y", "", figures},
                        {"z", "frames=5", figures},
                        {"unknown", "", figures}});
  book.tell_words("nobody", {{"z", "", {}}});
  CHECK(book.told("a", "x")->figures == instance_figures{});
  CHECK(book.told("a", "x")->status == "step 3 of 7");
  CHECK(book.told("a", "y")->figures.frames == 9);
  CHECK(book.told("a", "z")->figures.frames == 5);
  CHECK(book.told("a", "z")->status == "frames=5");
  CHECK_FALSE(book.told("a", "unknown"));
  CHECK_FALSE(book.told("nobody", "z"));
}

TEST_CASE("Measures are those of the rows that are known",
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), on("a", "t-1", "t"),
                   ended_on("a", "t-2", "t"), on("b", "t-3", "t")});
  auto row = told("t-0", "t");
  row.restarts = 2;
  row.figures.frames = 7;
  book.tell("a", row);
  book.tell("a", told("stray", "nobody's", instance_state::stopped));
  for (const bool untold : {false, true}) {
    const auto rows = book.known_on("a", untold);
    const auto measures = book.measures_on("a", untold);
    REQUIRE(measures.size() == rows.size());
    for (size_t i = 0; i < rows.size(); ++i)
      CHECK(measures[i] == measures_of(rows[i]));
  }
  CHECK(book.nodes_with_live() == std::set<std::string>{"a"});
  book.forget_node("a");
  CHECK(book.nodes_with_live().empty());
}

TEST_CASE("A task that is forgotten takes along what was told of it",
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t")});
  book.tell("a", told("t-0", "t"));
  book.forget_task("t");
  CHECK(book.known_on("a", true).empty());
  CHECK_FALSE(book.find("t-0"));
}

TEST_CASE("What has ended and is placed no more is forgotten",
          "[deployment_book]") {
  deployment_book book;
  book.place("t", {on("a", "t-0", "t"), on("b", "t-1", "t")});
  book.tell("a", told("t-0", "t"));
  book.tell("b", told("t-1", "t", instance_state::failed));
  // A move to b is undone; a runs on, until it says otherwise.
  book.place("t", {});
  CHECK(book.rows_on("a").size() == 1);
  CHECK(book.rows_on("b").empty());
}

TEST_CASE("What one node tells is bounded", "[deployment_book]") {
  deployment_book book;
  for (size_t i = 0; i < limits::instance::told; ++i)
    CHECK(book.tell("a", told("i" + std::to_string(i), "t")));
  CHECK_FALSE(book.tell("a", told("one-more", "t")));
  CHECK(book.tell("a", told("i0", "t", instance_state::failed)));
  CHECK(book.tell("b", told("one-more", "t")));
}

} // namespace roscell::test
