#include "actors/cell/limits.hpp"
#include "actors/cell/tables/task_table.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

task_accepted decision_of(const std::string& task,
                          const std::vector<std::string>& nodes) {
  task_accepted result;
  result.task = task;
  for (size_t i = 0; i < nodes.size(); ++i) {
    step_allocation x;
    x.step = "s" + std::to_string(i);
    x.node = nodes[i];
    result.allocations.push_back(x);
  }
  return result;
}

instance_spec spec_of(const std::string& task, const std::string& step,
                      const std::string& instance) {
  instance_spec result;
  result.task = task;
  result.step = step;
  result.instance = instance;
  result.parameters = "{}";
  return result;
}

/// A task that was placed on these nodes.
task_record record(const std::string& task, task_state state,
                   const std::vector<std::string>& nodes) {
  std::vector<instance_spec> specs;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto number = std::to_string(i);
    specs.push_back(spec_of(task, "s" + number, task + "-" + number));
  }
  task_record result;
  result.task = task;
  result.request = "{}";
  result.state = state;
  return with_placement(result, decision_of(task, nodes), specs, nodes);
}

instance_end end_of(const std::string& instance, int code) {
  return {instance,
          code == 0 ? instance_state::stopped : instance_state::failed, code,
          "", 7};
}

replacement moved(const task_record& from, size_t step,
                  const std::string& node) {
  replacement result;
  result.old_instance = from.specs[step].instance;
  result.spec = from.specs[step];
  result.spec.instance += "-new";
  result.place.step = from.specs[step].step;
  result.place.node = node;
  return result;
}

struct both_tables {
  task_table tasks;
  deployment_table deployments;

  void apply(const task_record& x) {
    tasks.apply(x);
    deployments.place(x.task, deployments_in(x));
  }

  task_accepted reply(const std::string& task) const {
    return reply_of(task, *tasks.find(task), deployments);
  }
};

} // namespace

TEST_CASE("A claim is granted once, and only for the same body",
          "[task_table]") {
  task_table tasks;
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::unknown);
  tasks.begin("t", "{}", "", 5);
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::deploying);
  CHECK(tasks.claim_status_of("t", "[]", "") == claim_status::other_body);
  tasks.apply(record("t", task_state::running, {"a"}));
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::accepted);
  CHECK(tasks.begin_ending("t"));
  CHECK_FALSE(tasks.begin_ending("t"));
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::ending);
  tasks.forget("t");
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::unknown);
}

TEST_CASE("An ended task is asked for once more under a new id only",
          "[task_table]") {
  task_table tasks;
  tasks.begin("t", "{}", "one", 5);
  const auto state =
      GENERATE(task_state::running, task_state::finished, task_state::failed);
  auto kept = record("t", state, {"a"});
  kept.request_ids = {"one"};
  kept = with_request(kept, "two");
  tasks.apply(kept);
  const auto other = state == task_state::running ? claim_status::accepted
                                                  : claim_status::next_run;
  CHECK(tasks.claim_status_of("t", "{}", "one") == claim_status::accepted);
  CHECK(tasks.claim_status_of("t", "{}", "two") == claim_status::accepted);
  CHECK(tasks.claim_status_of("t", "{}", "") == claim_status::accepted);
  CHECK(tasks.claim_status_of("t", "{}", "three") == other);
  CHECK(tasks.claim_status_of("t", "[]", "three") == claim_status::other_body);
}

TEST_CASE("A next run is counted, and taken back when it comes to nothing",
          "[task_table]") {
  both_tables tables;
  auto first = record("t", task_state::running, {"a"});
  first = with_ends(first, {end_of("t-0", 0)}, 7);
  first.request_ids = {"one"};
  tables.apply(first);
  REQUIRE(tables.tasks.find("t")->state == task_state::finished);
  tables.tasks.begin("t", "{}", "two", 9);
  CHECK(tables.tasks.is_deploying("t"));
  CHECK(tables.tasks.find("t")->run == 2);
  CHECK(tables.tasks.is_of_run("t", "two"));
  CHECK_FALSE(tables.tasks.is_of_run("t", "one"));
  SECTION("it is placed: nothing of the run before counts") {
    auto next = record_of("t", *tables.tasks.find("t"), tables.deployments);
    next = with_placement(next, decision_of("t", {"b"}),
                          {spec_of("t", "s0", "t-9")}, {"b"});
    next = with_ends(with_state(next, task_state::running), {}, 10);
    CHECK(next.state == task_state::running);
    CHECK(next.run == 2);
    CHECK(next.ends.empty());
  }
  SECTION("it is not") {
    tables.tasks.begin_ending("t");
    tables.tasks.take_back(first);
    CHECK(tables.tasks.find("t")->state == task_state::finished);
    CHECK(tables.tasks.find("t")->run == 1);
    CHECK(tables.tasks.is_kept("t"));
    CHECK(tables.tasks.is_of_run("t", "one"));
  }
}

TEST_CASE("The requests that are remembered of a run are bounded",
          "[task_table]") {
  auto x = record("t", task_state::running, {"a"});
  for (int i = 0; i < 100; ++i)
    x = with_request(x, "id" + std::to_string(i));
  CHECK(x.request_ids.size() == 16);
  CHECK(x.request_ids.back() == "id99");
  CHECK(with_request(x, "id99").request_ids == x.request_ids);
}

TEST_CASE("A node's new name stands wherever its old one stood",
          "[task_table]") {
  both_tables tables;
  tables.apply(record("t", task_state::running, {"a", "b"}));
  tables.apply(record("u", task_state::running, {"b"}));
  instance_row row;
  row.spec = spec_of("t", "s0", "t-0");
  row.state = instance_state::running;
  tables.deployments.note_row("a", row);
  CHECK(tables.deployments.rename_node("a", "c") == std::set<std::string>{"t"});
  CHECK(tables.deployments.find("t-0", "c"));
  CHECK_FALSE(tables.deployments.find("t-0", "a"));
  REQUIRE(tables.deployments.reported("c", "t-0"));
  CHECK(tables.deployments.reported("c", "t-0")->node == "c");
  CHECK(tables.deployments.rows_on("a").empty());
  const auto kept = with_renamed(
      record_of("t", *tables.tasks.find("t"), tables.deployments), "a", "c");
  CHECK(kept.nodes == std::vector<std::string>{"c", "b"});
  tables.apply(kept);
  const auto reply = tables.reply("t");
  CHECK(reply.allocations[0].node == "c");
  CHECK(reply.instances[0].node == "c");
  CHECK(reply.instances[1].node == "b");
}

TEST_CASE("A task is what the store has kept of it", "[task_table]") {
  task_table tasks;
  tasks.begin("t", "{}", "", 5);
  CHECK(tasks.is_deploying("t"));
  CHECK_FALSE(tasks.is_running("t"));
  tasks.apply(record("t", task_state::running, {"a"}));
  CHECK(tasks.is_running("t"));
  CHECK(tasks.is_kept("t"));
  tasks.begin_ending("t");
  CHECK_FALSE(tasks.is_running("t"));
  CHECK_FALSE(tasks.is_kept("t"));
}

TEST_CASE("A task is finished when every step has ended with 0",
          "[task_table]") {
  auto x = record("t", task_state::running, {"a", "b"});
  x = with_ends(x, {end_of("t-0", 0)}, 7000);
  CHECK(x.state == task_state::running);
  x = with_ends(x, {end_of("t-0", 0), end_of("t-1", 0)}, 7000);
  CHECK(x.ends.size() == 2);
  CHECK(x.state == task_state::finished);
  CHECK(x.ended_unix_ms == 7000);
}

TEST_CASE("A task has failed when every step has ended, not all with 0",
          "[task_table]") {
  auto x = record("t", task_state::running, {"a", "b"});
  x = with_ends(x, {end_of("t-0", 3)}, 7000);
  CHECK(x.state == task_state::running);
  CHECK(with_ends(x, {end_of("t-1", 0)}, 7000).state == task_state::failed);
}

TEST_CASE("An end of a task that is deploying does not make it run",
          "[task_table]") {
  const auto x = record("t", task_state::deploying, {"a"});
  CHECK(with_ends(x, {end_of("t-0", 0)}, 7000).state == task_state::deploying);
}

TEST_CASE("A record says what both tables know", "[task_table]") {
  both_tables tables;
  auto x = record("t", task_state::running, {"a", "b"});
  x = with_ends(x, {end_of("t-1", 0)}, 7000);
  tables.apply(x);
  const auto again =
      record_of("t", *tables.tasks.find("t"), tables.deployments);
  CHECK(json(again) == json(x));
  CHECK(json(again).get<task_record>() == again);
}

TEST_CASE("The reply says where instances are now", "[task_table]") {
  both_tables tables;
  const auto x = record("t", task_state::running, {"a", "b"});
  tables.apply(x);
  CHECK(tables.reply("t").instances.at(1).node == "b");
  tables.apply(
      with_replaced(with_tentative(x, {moved(x, 1, "c")}), {moved(x, 1, "c")}));
  const auto reply = tables.reply("t");
  REQUIRE(reply.instances.size() == 2);
  CHECK(reply.instances[1].node == "c");
  CHECK(reply.instances[1].instance == "t-1-new");
  CHECK(reply.allocations.at(1).node == "c");
  CHECK(reply.instances[0].node == "a");
}

TEST_CASE("What moves is in its old place until the new one runs",
          "[task_table]") {
  both_tables tables;
  const auto x = record("t", task_state::running, {"a"});
  const auto moving = with_tentative(x, {moved(x, 0, "c")});
  tables.apply(moving);
  CHECK(tables.deployments.of_task("t").size() == 2);
  CHECK(tables.reply("t").instances.at(0).node == "a");
  CHECK(tables.deployments.bound_to("c").size() == 1);
  tables.apply(without(moving, {"t-0-new"}));
  CHECK(tables.deployments.of_task("t").size() == 1);
  CHECK(tables.deployments.bound_to("c").empty());
}

TEST_CASE("What ended while it was to move is not run again", "[task_table]") {
  const auto x = record("t", task_state::running, {"a"});
  auto moving = with_tentative(x, {moved(x, 0, "c")});
  moving = with_ends(moving, {end_of("t-0", 0)}, 7000);
  const auto after = with_replaced(moving, {moved(x, 0, "c")});
  REQUIRE(after.specs.size() == 1);
  CHECK(after.specs[0].instance == "t-0");
  CHECK(after.ends.size() == 1);
}

TEST_CASE("A restart takes up what ran, without moves that went on",
          "[task_table]") {
  CHECK_FALSE(restored(record("t", task_state::deploying, {"a"})));
  CHECK_FALSE(restored(record("t", task_state::terminating, {"a"})));
  CHECK(restored(record("t", task_state::finished, {"a"})));
  const auto x = record("t", task_state::running, {"a"});
  const auto again = restored(with_tentative(x, {moved(x, 0, "c")}));
  REQUIRE(again);
  CHECK(again->specs.size() == 1);
  CHECK(again->tentative.empty());
}

TEST_CASE("A record of the version before is read", "[task_table]") {
  const auto x = record("t", task_state::running, {"a"});
  auto old = json(x);
  old.erase("ends");
  old.erase("tentative");
  auto accepted = json::parse(x.accepted);
  accepted["instances"] = {
      {{"step", "s0"}, {"instance", "elsewhere"}, {"node", "z"}}};
  old["accepted"] = accepted.dump();
  both_tables tables;
  tables.apply(old.get<task_record>());
  REQUIRE(tables.reply("t").instances.size() == 1);
  CHECK(tables.reply("t").instances[0].node == "a");
}

TEST_CASE("A reply that cannot be read is answered by what is known",
          "[task_table]") {
  both_tables tables;
  auto x = record("t", task_state::running, {"a"});
  x.accepted = "{ broken";
  tables.apply(x);
  CHECK(tables.reply("t").task == "t");
  CHECK(tables.reply("t").instances.size() == 1);
}

TEST_CASE("The newest settled tasks are kept", "[task_table]") {
  task_table tasks;
  for (int i = 0; i < 105; ++i) {
    auto x = record("t" + std::to_string(1000 + i), task_state::finished, {});
    x.submitted_unix_ms = i;
    tasks.apply(x);
  }
  tasks.apply(record("running", task_state::running, {}));
  const auto old = tasks.superfluous();
  REQUIRE(old.size() == 5);
  CHECK(old.front() == "t1000");
  CHECK(old.back() == "t1004");
}

TEST_CASE("Tasks are bounded", "[task_table]") {
  task_table tasks;
  for (size_t i = 0; i < limits::task::most; ++i) {
    CHECK_FALSE(tasks.is_full());
    tasks.begin("t" + std::to_string(i), "{}", "", 0);
  }
  CHECK(tasks.is_full());
}

TEST_CASE("The newest 100 terminated tasks are remembered", "[task_table]") {
  task_table tasks;
  for (int i = 0; i < 150; ++i)
    tasks.remember_terminated({"t" + std::to_string(i), {}, {}});
  CHECK(tasks.find_terminated("t50"));
  CHECK(tasks.find_terminated("t149"));
  CHECK_FALSE(tasks.find_terminated("t49"));
}

TEST_CASE("A task that was terminated twice is remembered by its last end",
          "[task_table]") {
  task_table tasks;
  tasks.remember_terminated({"t", {"t-1"}, {}});
  tasks.remember_terminated({"t", {"t-2"}, {}});
  REQUIRE(tasks.find_terminated("t"));
  CHECK(tasks.find_terminated("t")->instances
        == std::vector<std::string>{"t-2"});
}

} // namespace roscell::test
