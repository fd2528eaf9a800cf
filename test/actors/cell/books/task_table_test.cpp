#include "actors/cell/books/task_table.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

task_record record(const std::string& task, task_state state,
                   const std::vector<std::string>& nodes) {
  task_record result;
  result.task = task;
  result.state = state;
  for (size_t i = 0; i < nodes.size(); ++i) {
    instance_spec spec;
    spec.task = task;
    spec.instance = task + "-" + std::to_string(i);
    result.specs.push_back(spec);
    result.nodes.push_back(nodes[i]);
  }
  return result;
}

} // namespace

TEST_CASE("An instance is wanted on the node of its step only",
          "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::running, {"a", "b"}));
  CHECK(tasks.find_spec("t-0", "a"));
  CHECK(tasks.find_spec("t-1", "b"));
  CHECK_FALSE(tasks.find_spec("t-0", "b"));
  CHECK_FALSE(tasks.find_spec("t-2", "a"));
}

TEST_CASE("A deploying task's instances are kept, and not started again",
          "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::deploying, {"a"}));
  CHECK(tasks.find_spec("t-0", "a"));
  CHECK(tasks.wanted_on("a").empty());
}

TEST_CASE("Nothing of a task that is being terminated is wanted",
          "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::terminating, {"a"}));
  CHECK_FALSE(tasks.find_spec("t-0", "a"));
  CHECK(tasks.wanted_on("a").empty());
}

TEST_CASE("What running tasks want on a node is all of theirs there",
          "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::running, {"a", "b", "a"}));
  tasks.add(record("u", task_state::running, {"a"}));
  const auto wanted = tasks.wanted_on("a");
  REQUIRE(wanted.size() == 3);
  CHECK(wanted[0].instance == "t-0");
  CHECK(wanted[1].instance == "t-2");
  CHECK(wanted[2].instance == "u-0");
  CHECK(tasks.wanted_on("c").empty());
}

TEST_CASE("What a deploying or ending task has on a node is bound to it",
          "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::deploying, {"a", "b", "a"}));
  tasks.add(record("u", task_state::running, {"a"}));
  tasks.add(record("v", task_state::terminating, {"b"}));
  CHECK(tasks.bound_to("a").size() == 3);
  CHECK(tasks.tasks_bound_to("a") == std::vector<std::string>{"t", "u"});
  CHECK(tasks.tasks_bound_to("b") == std::vector<std::string>{"t", "v"});
  CHECK(tasks.is_deploying_on("b"));
  tasks.find("t")->record.state = task_state::running;
  CHECK_FALSE(tasks.is_deploying_on("b"));
}

TEST_CASE("A task without an owner is nobody's", "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::running, {}));
  CHECK(tasks.find_owned_by(caf::actor_addr{}) == nullptr);
}

TEST_CASE("The newest 100 ended tasks are remembered", "[task_table]") {
  task_table tasks;
  for (int i = 0; i < 150; ++i)
    tasks.remember_ended({"t" + std::to_string(i), {}, {}});
  CHECK(tasks.find_ended("t50"));
  CHECK(tasks.find_ended("t149"));
  CHECK_FALSE(tasks.find_ended("t49"));
}

TEST_CASE("A task that ended twice is remembered by its last end",
          "[task_table]") {
  task_table tasks;
  tasks.remember_ended({"t", {"t-1"}, {}});
  tasks.remember_ended({"t", {"t-2"}, {}});
  REQUIRE(tasks.find_ended("t"));
  CHECK(tasks.find_ended("t")->instances == std::vector<std::string>{"t-2"});
}

TEST_CASE("An erased task is unknown", "[task_table]") {
  task_table tasks;
  tasks.add(record("t", task_state::running, {"a"}));
  REQUIRE(tasks.find("t"));
  tasks.erase("t");
  CHECK_FALSE(tasks.find("t"));
  CHECK(tasks.entries().empty());
}

} // namespace roscell::test
