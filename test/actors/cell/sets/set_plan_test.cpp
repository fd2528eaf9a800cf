#include "actors/cell/sets/set_plan.hpp"
#include "actors/cell/sets/set_table.hpp"
#include "actors/cell/sets/set_template.hpp"
#include "actors/placement/reading/task_reading.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

/// What a set of tasks asks for, and what of it can be done now. Pure.
namespace roscell::test {

namespace {

using namespace std::chrono_literals;

task_set_request patrol(const std::string& version = "1") {
  task_set_request result;
  result.task = "patrol";
  result.for_each.node.labels = {{"kind", "robot"}};
  task_step step{"drive", "echo", "plain"};
  step.env = {{"VERSION", version}, {"ON", "${node}"}};
  result.pipeline = {step};
  return result;
}

set_node robot() {
  set_node result;
  result.labels = {{"kind", "robot"}};
  return result;
}

set_task present(const std::string& node, const std::string& version = "1") {
  set_task result;
  result.set = "patrol";
  result.body =
      body_of(std::get<task_request>(task_for(patrol(version), node)));
  result.is_of_run = true;
  result.nodes = {node};
  return result;
}

set_question asked(const std::map<std::string, set_node>& nodes,
                   const std::map<std::string, set_task>& tasks = {}) {
  set_question result;
  result.request = patrol();
  result.nodes = nodes;
  result.tasks = tasks;
  return result;
}

set_step only(const std::vector<set_step>& steps) {
  REQUIRE(steps.size() == 1);
  return steps.front();
}

std::vector<std::string> nodes_in(const std::vector<set_step>& steps) {
  std::vector<std::string> result;
  for (const auto& x : steps)
    result.push_back(x.change.node);
  return result;
}

using names = std::vector<std::string>;

std::vector<set_step> planned(const set_question& question) {
  node_tasks tasks;
  return plan_set(question, tasks);
}

/// A table with one set, and what `plan_set` says.
struct known_set {
  set_table table;
  set_table::time_point now = set_table::time_point{} + 1h;

  explicit known_set(int64_t at_once = 1) {
    auto request = patrol();
    request.for_each.at_once = at_once;
    write(request);
  }

  void write(const task_set_request& request, int64_t revision = 1) {
    REQUIRE(table.apply({"patrol", body_of(request), 1, revision, 1, {}}));
  }

  std::vector<set_step> admitted(const std::vector<set_step>& steps,
                                 size_t being_changed = 0) {
    return table.admit("patrol", steps, being_changed, now);
  }

  static set_step doing(const std::string& node, set_action what) {
    set_step result;
    result.change = {node, "patrol-" + node, what, ""};
    return result;
  }
};

} // namespace

TEST_CASE("A node's task has its name, and is placed there", "[task_sets]") {
  auto set = patrol();
  set.pipeline.push_back(set.pipeline.front());
  set.pipeline.back().id = "plan";
  set.pipeline.back().anywhere = true;
  set.pipeline.back().copies = 2;
  set.labels = {{"line", "3"}};
  const auto task = std::get<task_request>(task_for(set, "r1"));
  CHECK(task.task == "patrol-r1");
  CHECK(task.set == "patrol");
  CHECK(task.labels == set.labels);
  REQUIRE(task.pipeline.size() == 3);
  CHECK(task.pipeline[0].env.at("ON") == "r1");
  CHECK(task.pipeline[0].labels.at("node") == "r1");
  CHECK(task.pipeline[1].id == "plan-1");
  CHECK(task.pipeline[1].labels.count("node") == 0);
  CHECK_FALSE(task.pipeline[1].anywhere);
}

TEST_CASE("A name that would be too long is refused with its node",
          "[task_sets]") {
  auto set = patrol();
  set.task = std::string(40, 's');
  CHECK(std::holds_alternative<task_request>(
      task_for(set, std::string(22, 'n'))));
  const auto why = task_for(set, std::string(23, 'n'));
  CHECK(std::get<failure>(why).where == "/task");
}

TEST_CASE("Each node with the labels gets a task, others get none",
          "[task_sets]") {
  auto other = robot();
  other.labels = {{"kind", "desk"}};
  auto drained = robot();
  drained.is_draining = true;
  const auto steps =
      planned(asked({{"r1", robot()}, {"desk", other}, {"r2", drained}}));
  CHECK(only(steps).change.action == set_action::starts);
  CHECK(only(steps).change.task == "patrol-r1");
  CHECK(planned(asked({{"desk", other}})).empty());
}

TEST_CASE("A task stays while its request does, and is changed where not",
          "[task_sets]") {
  CHECK(only(planned(asked({{"r1", robot()}}, {{"patrol-r1", present("r1")}})))
            .change.action
        == set_action::stays);
  CHECK(only(planned(
                 asked({{"r1", robot()}}, {{"patrol-r1", present("r1", "0")}})))
            .change.action
        == set_action::changes);
}

TEST_CASE("What has ended runs once more for another run or request only",
          "[task_sets]") {
  auto ended = present("r1");
  ended.is_settled = true;
  const auto action = [&](const set_task& x) {
    return only(planned(asked({{"r1", robot()}}, {{"patrol-r1", x}})))
        .change.action;
  };
  CHECK(action(ended) == set_action::stays);
  ended.is_of_run = false;
  CHECK(action(ended) == set_action::runs);
  ended = present("r1", "0");
  ended.is_settled = true;
  CHECK(action(ended) == set_action::runs);
}

TEST_CASE("What runs is asked for under another run, and stays",
          "[task_sets]") {
  auto runs = present("r1");
  CHECK_FALSE(
      only(planned(asked({{"r1", robot()}}, {{"patrol-r1", runs}}))).joins);
  runs.is_of_run = false;
  const auto step =
      only(planned(asked({{"r1", robot()}}, {{"patrol-r1", runs}})));
  CHECK(step.joins);
  CHECK(step.change.action == set_action::stays);
}

TEST_CASE("A task ends where the set is not for its node", "[task_sets]") {
  auto without = robot();
  without.labels.clear();
  auto question = asked({{"r1", without}}, {{"patrol-r1", present("r1")}});
  CHECK(only(planned(question)).change.action == set_action::stops);
  question.nodes["r1"] = robot();
  CHECK(only(planned(question)).change.action == set_action::stays);
  question.stopped = {"r1"};
  CHECK(only(planned(question)).change.action == set_action::stops);
  question.stopped.clear();
  question.nodes.clear();
  CHECK(only(planned(question)).change.action == set_action::stops);
}

TEST_CASE("Of a node whose labels nobody knows yet nothing is said",
          "[task_sets]") {
  set_node unknown;
  unknown.is_unknown = true;
  CHECK(planned(asked({{"r1", unknown}}, {{"patrol-r1", present("r1")}}))
            .empty());
  CHECK(planned(asked({{"r1", unknown}})).empty());
}

TEST_CASE("A node that was renamed begins its task once the former one is gone",
          "[task_sets]") {
  auto former = present("old");
  former.nodes = {"new"};
  const auto steps = planned(
      asked({{"new", robot()}, {"r2", robot()}}, {{"patrol-old", former}}));
  REQUIRE(steps.size() == 3);
  CHECK(steps[0].change.task == "patrol-new");
  CHECK(steps[0].is_held);
  CHECK_FALSE(steps[1].is_held);
  CHECK(steps[2].change.action == set_action::stops);
  CHECK(steps[2].change.node == "old");
}

TEST_CASE("A task of somebody else is left alone", "[task_sets]") {
  auto foreign = present("r1");
  foreign.set.clear();
  const auto step =
      only(planned(asked({{"r1", robot()}}, {{"patrol-r1", foreign}})));
  CHECK_FALSE(step.problem.empty());
  auto without = robot();
  without.labels.clear();
  CHECK(planned(asked({{"r1", without}}, {{"patrol-r1", foreign}})).empty());
}

TEST_CASE("What is away, ending or busy is waited for", "[task_sets]") {
  auto away = robot();
  away.is_away = true;
  CHECK(only(planned(asked({{"r1", away}}))).is_held);
  for (auto flag : {&set_task::is_ending, &set_task::is_busy}) {
    auto task = present("r1", "0");
    task.*flag = true;
    CHECK(
        only(planned(asked({{"r1", robot()}}, {{"patrol-r1", task}}))).is_held);
  }
}

TEST_CASE("So many tasks of a set are changed at a time", "[task_sets]") {
  const std::vector<set_step> steps{known_set::doing("a", set_action::changes),
                                    known_set::doing("b", set_action::changes),
                                    known_set::doing("c", set_action::changes),
                                    known_set::doing("d", set_action::starts)};
  known_set two{2};
  CHECK(nodes_in(two.admitted(steps)) == names{"a", "b", "d"});
  CHECK(nodes_in(two.admitted(steps, 1)) == names{"a", "d"});
  CHECK(nodes_in(two.admitted(steps, 2)) == names{"d"});
  two.table.begin("patrol", steps[0]);
  CHECK(nodes_in(two.admitted(steps)) == names{"b", "d"});
}

TEST_CASE("One change that was put back keeps the others from being changed",
          "[task_sets]") {
  auto broken = present("a", "0");
  broken.update_problem = "step 'drive' has failed";
  const auto steps =
      planned(asked({{"a", robot()}, {"b", robot()}, {"c", robot()}},
                    {{"patrol-a", broken}, {"patrol-b", present("b", "0")}}));
  known_set set{10};
  // That of an earlier request says nothing of this one.
  CHECK(nodes_in(set.admitted(steps)) == names{"a", "b", "c"});
  CHECK(set.table.problem("patrol", steps[0]).empty());
  set.table.begin("patrol", steps[0]);
  set.table.end("patrol", "a", "", set.now);
  CHECK(nodes_in(set.admitted(steps)) == names{"c"});
  CHECK(set.table.problem("patrol", steps[0])
        == "its change was put back: step 'drive' has failed");
  set.write(patrol("2"), 2);
  CHECK(nodes_in(set.admitted(steps)) == names{"a", "c"});
}

TEST_CASE(
    "What fails is tried again after ever longer pauses, and is news once",
    "[task_sets]") {
  known_set set;
  const std::vector<set_step> steps{known_set::doing("a", set_action::starts)};
  auto last = 0ms;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(set.admitted(steps).size() == 1);
    set.table.begin("patrol", steps[0]);
    CHECK(set.admitted(steps).empty());
    CHECK(set.table.end("patrol", "a", "no room", set.now) == (i == 0));
    CHECK(set.table.problem("patrol", steps[0]) == "no room");
    set.table.take_due(set.now);
    CHECK(set.admitted(steps).empty());
    const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(
        set.table.next_due() - set.now);
    CHECK(pause > last / 2);
    last = pause;
    set.now = set.table.next_due();
  }
  set.table.begin("patrol", steps[0]);
  CHECK_FALSE(set.table.end("patrol", "a", "", set.now));
  CHECK(set.table.problem("patrol", steps[0]).empty());
}

TEST_CASE("Another request, or the node's return, is tried at once",
          "[task_sets]") {
  known_set set;
  const std::vector<set_step> steps{known_set::doing("a", set_action::starts)};
  const auto fail = [&] {
    set.table.begin("patrol", steps[0]);
    set.table.end("patrol", "a", "no room", set.now);
    REQUIRE(set.admitted(steps).empty());
  };
  fail();
  set.write(patrol("2"), 2);
  CHECK(set.admitted(steps).size() == 1);
  CHECK(set.table.problem("patrol", steps[0]).empty());
  fail();
  set.table.forgive("b");
  CHECK(set.admitted(steps).empty());
  set.table.forgive("a");
  CHECK(set.admitted(steps).size() == 1);
}

TEST_CASE("Not too much is done at a time", "[task_sets]") {
  known_set set;
  std::vector<set_step> steps;
  for (int i = 0; i < 100; ++i)
    steps.push_back(
        known_set::doing("n" + std::to_string(i), set_action::starts));
  const auto first = set.admitted(steps);
  CHECK(first.size() == 32);
  for (const auto& x : first)
    set.table.begin("patrol", x);
  CHECK(set.admitted(steps).empty());
  set.table.end("patrol", "n0", "", set.now);
  CHECK(set.admitted(steps).size() == 1);
}

TEST_CASE("What is held, stays or cannot be done is not begun", "[task_sets]") {
  known_set set;
  auto held = known_set::doing("a", set_action::starts);
  held.is_held = true;
  auto stuck = known_set::doing("b", set_action::starts);
  stuck.problem = "no";
  auto joins = known_set::doing("c", set_action::stays);
  joins.joins = true;
  CHECK(nodes_in(set.admitted(
            {held, stuck, known_set::doing("d", set_action::stays), joins}))
        == names{"c"});
}

} // namespace roscell::test
