#include "test/actors/fakes/coordinator_fakes.hpp"

#include "test/words.hpp"

#include <set>

namespace roscell::test {

namespace {

json error_body(const json& reply) {
  REQUIRE(error_of(reply) != "");
  return reply.at("error");
}

std::string text_in(const json& error, const std::string& field) {
  return error.at(field).get<std::string>();
}

using roscell::test::has;

/// A cell of three nodes with 4 cores each.
struct three_nodes : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  size_t running() const {
    return base.running.size() + left.running.size() + right.running.size();
  }

  /// Two steps that need a node each: "left" and "right".
  json both(const std::string& task) {
    return echo_task(task,
                     {echo_step("s0", 3, "left"), echo_step("s1", 3, "right")});
  }
};

} // namespace

TEST_CASE_METHOD(three_nodes,
                 "A task is accepted once all its steps run, with their ids",
                 "[task_pipeline]") {
  const auto reply = request(both("t"));
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("task") == "t");
  CHECK(reply.at("allocations").size() == 2);
  REQUIRE(reply.at("instances").size() == 2);
  const auto& placed = reply.at("instances")[0];
  CHECK(placed.at("step") == "s0");
  CHECK(placed.at("node") == "left");
  const auto id = placed.at("instance").get<std::string>();
  CHECK(id.rfind("t-s0-", 0) == 0);
  CHECK(id.size() == 13);
  REQUIRE(left.running.count(id) == 1);
  CHECK(right.running.size() == 1);
  CHECK(base.running.empty());
  REQUIRE(tasks().size() == 1);
  CHECK(tasks()[0].at("state") == "running");
  CHECK(disk.at("t").at("state") == "running");
  CHECK(count("allocation_chosen") == 1);
  CHECK(count("task_accepted") == 1);
}

TEST_CASE_METHOD(three_nodes, "An instance is told all that it needs to know",
                 "[task_pipeline]") {
  auto task = echo_task("t", {echo_step("s0", 2, "left")});
  task["pipeline"][0]["parameters"] = {{"times", 5}};
  task["pipeline"][0]["input"] = {{"protocol", "file"},
                                  {"endpoint", "/data/in"},
                                  {"data_type", "text/plain"}};
  REQUIRE(request(task).at("type") == "task_accepted");
  REQUIRE(left.deployments.size() == 1);
  const auto& spec = left.deployments[0];
  CHECK(spec.task == "t");
  CHECK(spec.step == "s0");
  CHECK(spec.operation == "echo");
  CHECK(spec.model == "plain");
  CHECK(spec.deployment == "cpu-2");
  CHECK(spec.skill == echo_skill().hash);
  CHECK(spec.cell == "lab");
  CHECK(spec.resources.cpu == 2);
  CHECK(spec.gpu == -1);
  CHECK(json::parse(spec.parameters) == json{{"shout", false}, {"times", 5}});
  CHECK(spec.environment.at("OMP_NUM_THREADS") == "1");
  // The cell's, although the deployment option has one of its own.
  CHECK(spec.environment.at("ROS_DOMAIN_ID") == "7");
  REQUIRE(spec.input.size() == 1);
  CHECK(spec.input[0].endpoint == "/data/in");
}

TEST_CASE_METHOD(three_nodes, "The same task again changes nothing",
                 "[task_pipeline]") {
  const auto first = request(both("t"));
  CHECK(placement_in(request(both("t"))) == placement_in(first));
  // A request id is not part of the task.
  auto again = both("t");
  again["request_id"] = "another";
  CHECK(placement_in(request(again)) == placement_in(first));
  CHECK(running() == 2);
}

TEST_CASE_METHOD(three_nodes,
                 "The same task while it is deployed waits for the first reply",
                 "[task_pipeline]") {
  right.mood = temper::slow;
  const auto first = post(both("t"));
  const auto second = post(both("t"));
  CHECK_FALSE(*first);
  CHECK_FALSE(*second);
  CHECK(tasks()[0].at("state") == "deploying");
  right.finish_starting();
  time.settle();
  REQUIRE(*second);
  CHECK(reply_of(first).at("type") == "task_accepted");
  CHECK(placement_in(reply_of(second)) == placement_in(reply_of(first)));
  CHECK(left.deployments.size() == 1);
}

TEST_CASE_METHOD(three_nodes, "A task id with another body is refused",
                 "[task_pipeline]") {
  request(both("t"));
  const auto other = echo_task("t", {echo_step("s0", 1)});
  auto error = error_body(request(other));
  CHECK(error.at("code") == "task_exists");
  CHECK(error.at("where") == "/task");
  CHECK(running() == 2);
  // ... while it is deployed too.
  left.mood = temper::slow;
  const auto pending = post(echo_task("u", {echo_step("s0", 1, "left")}));
  CHECK(error_of(request(echo_task("u", {echo_step("s0", 1)})))
        == "task_exists");
  CHECK_FALSE(*pending);
}

TEST_CASE_METHOD(three_nodes,
                 "If one step fails to start, the others are rolled back",
                 "[task_pipeline]") {
  right.mood = temper::broken;
  const auto error = error_body(request(both("t")));
  CHECK(error.at("code") == "engine_failed");
  CHECK(error.at("where") == "/pipeline/1");
  const auto message = text_in(error, "message");
  CHECK(has(message, "'s1'"));
  CHECK(has(message, "'right'"));
  CHECK(has(message, "exited with code 3"));
  CHECK(has(text_in(error, "hint"), "rolled back"));

  CHECK(running() == 0);
  REQUIRE(left.removals.size() == 1);
  CHECK(left.removals[0].task == "t");
  CHECK(right.removals.size() == 1);
  CHECK(base.removals.empty());
  CHECK(tasks().empty());
  CHECK(disk.empty());
  CHECK(count("task_failed") == 1);
  // Everything is free again, the id too.
  right.mood = temper::happy;
  CHECK(request(both("t")).at("type") == "task_accepted");
}

TEST_CASE_METHOD(three_nodes,
                 "A failure is answered when the rollback has been done",
                 "[task_pipeline]") {
  right.mood = temper::broken;
  left.slow_removals = true;
  const auto reply = post(both("t"));
  CHECK_FALSE(*reply);
  left.finish_removals();
  time.settle();
  CHECK(error_of(reply_of(reply)) == "engine_failed");
}

TEST_CASE_METHOD(three_nodes,
                 "Who waits for a task that fails is told to send it again",
                 "[task_pipeline]") {
  left.mood = temper::slow;
  const auto first = post(both("t"));
  const auto second = post(both("t"));
  left.fail_starting("no such program");
  time.settle();
  CHECK(error_of(reply_of(first)) == "engine_failed");
  const auto error = error_body(reply_of(second));
  CHECK(has(text_in(error, "message"), "no such program"));
  CHECK(has(text_in(error, "hint"), "again"));
}

TEST_CASE_METHOD(three_nodes,
                 "A pipeline killed in the middle of a deployment is undone",
                 "[task_pipeline]") {
  right.mood = temper::slow;
  const auto reply = post(both("t"));
  REQUIRE(right.deployer);
  time.kill(right.deployer);
  REQUIRE(*reply);
  CHECK(error_of(reply_of(reply)) == "internal");
  CHECK(running() == 0);
  CHECK(left.removals.size() == 1);
  CHECK(right.removals.size() == 1);
  CHECK(tasks().empty());
  CHECK(disk.empty());
  right.mood = temper::happy;
  CHECK(request(both("t")).at("type") == "task_accepted");
}

TEST_CASE_METHOD(three_nodes,
                 "Two requests at once never count on the same resources",
                 "[task_pipeline]") {
  base.has.cpu.used = 4;
  right.has.cpu.used = 4;
  std::vector<pending_reply> replies;
  for (int i = 0; i < 5; ++i)
    replies.push_back(time.ask<request_routed>(
        router,
        route_request{
            echo_task("t" + std::to_string(i), {echo_step("s0", 2)}).dump()}));
  time.settle();
  size_t accepted = 0;
  for (const auto& x : replies) {
    const auto reply = reply_of(x);
    accepted += reply.at("type") == "task_accepted" ? 1 : 0;
    if (reply.at("type") == "error")
      CHECK(error_of(reply) == "no_feasible_allocation");
  }
  CHECK(accepted == 2);
  CHECK(left.running.size() == 2);
}

TEST_CASE_METHOD(three_nodes,
                 "A report that was on its way hides no new instance",
                 "[task_pipeline]") {
  base.has.cpu.used = 4;
  right.has.cpu.used = 4;
  // The second request asks the node before the first one's deployment is
  // there.
  slow_disk = true;
  const auto first = post(echo_task("t0", {echo_step("s0", 3)}));
  const auto second = post(echo_task("t1", {echo_step("s0", 3)}));
  left.slow_reports = true;
  slow_disk = false;
  finish_writes();
  time.settle();
  REQUIRE(left.reports.size() == 1);
  REQUIRE(reply_of(first).at("type") == "task_accepted");
  left.slow_reports = false;
  left.finish_reports();
  time.settle();
  CHECK(error_of(reply_of(second)) == "no_feasible_allocation");
  CHECK(left.running.size() == 1);
}

TEST_CASE_METHOD(three_nodes,
                 "A deployment holds its resources before the node knows of it",
                 "[task_pipeline]") {
  base.has.cpu.used = 4;
  right.has.cpu.used = 4;
  slow_disk = true;
  const auto first = post(echo_task("t0", {echo_step("s0", 3)}));
  const auto second = post(echo_task("t1", {echo_step("s0", 2)}));
  CHECK(left.deployments.empty());
  slow_disk = false;
  finish_writes();
  time.settle();
  CHECK(reply_of(first).at("type") == "task_accepted");
  CHECK(error_of(reply_of(second)) == "no_feasible_allocation");
}

TEST_CASE_METHOD(three_nodes,
                 "A node that does not answer is left out after 3 seconds",
                 "[task_pipeline]") {
  left.silent = true;
  const auto reply = post(echo_task("t", {echo_step("s0", 4)}));
  time.advance(2900ms);
  CHECK_FALSE(*reply);
  time.advance(200ms);
  REQUIRE(*reply);
  CHECK(reply_of(reply).at("type") == "task_accepted");
  CHECK(left.deployments.empty());
  const auto here = post(echo_task("u", {echo_step("s0", 1, "left")}));
  time.advance(3100ms);
  CHECK(error_of(reply_of(here)) == "no_feasible_allocation");
}

TEST_CASE_METHOD(three_nodes,
                 "A node lost between placement and intent is a conflict",
                 "[task_pipeline]") {
  size_t conflicts = 0;
  for (size_t handled = 0; handled < 60; ++handled) {
    const auto reply =
        time.ask<request_routed>(router, route_request{both("t").dump()});
    for (size_t i = 0; i < handled && time.scheduler.has_job(); ++i)
      time.scheduler.run_once();
    lose(left);
    if (error_of(reply_of(reply)) == "conflict") {
      ++conflicts;
      const auto error = reply_of(reply).at("error");
      CHECK(has(text_in(error, "message"), "'left' left"));
      CHECK(running() == 0);
      CHECK(tasks().empty());
      CHECK(disk.empty());
    }
    request(termination("t"));
    left.running.clear();
    REQUIRE(enter(left));
  }
  CHECK(conflicts > 0);
  CHECK(request(both("t")).at("type") == "task_accepted");
}

TEST_CASE_METHOD(three_nodes, "A plan query holds and starts nothing",
                 "[task_pipeline]") {
  auto query = both("t");
  query["type"] = "task_plan_query";
  const auto plan = request(query);
  REQUIRE(plan.at("type") == "task_plan");
  CHECK(plan.at("allocations").size() == 2);
  CHECK(plan.at("optimal") == true);
  CHECK(running() == 0);
  CHECK(disk.empty());
  CHECK(tasks().empty());
  CHECK(request(query) == plan);
  // Live requests have a searcher of their own.
  const auto planner_state = time.ask<actor_state>(planner, state_query{});
  time.settle();
  REQUIRE(*planner_state);
  const auto counts = json::parse((**planner_state)->json_text);
  CHECK(counts.at("trials") == 2);
  CHECK(counts.at("questions") == 0);
  // Its id stays free for a task with another body.
  CHECK(request(echo_task("t", {echo_step("s0", 4, "left")})).at("type")
        == "task_accepted");
}

TEST_CASE_METHOD(three_nodes,
                 "A task that fits nowhere is refused with the reasons",
                 "[task_pipeline]") {
  left.has.cpu.used = 1.5;
  const auto error =
      error_body(request(echo_task("t", {echo_step("s0", 3, "left")})));
  CHECK(error.at("code") == "no_feasible_allocation");
  std::set<std::string> nodes;
  for (const auto& x : error.at("rejected")) {
    nodes.insert(x.at("node").get<std::string>());
    CHECK(x.at("deployment") == "cpu-3");
    CHECK_FALSE(x.at("reasons").empty());
  }
  CHECK(nodes == std::set<std::string>{"base", "left", "right"});
  // The turn goes on, and the id is free.
  CHECK(request(echo_task("t", {echo_step("s0", 1)})).at("type")
        == "task_accepted");
}

TEST_CASE_METHOD(
    three_nodes,
    "Unknown words of a step are refused with a pointer and a hint",
    "[task_pipeline]") {
  auto task = both("t");
  task["pipeline"][1]["operation"] = "dance";
  auto error = error_body(request(task));
  CHECK(error.at("code") == "unknown_operation");
  CHECK(error.at("where") == "/pipeline/1/operation");
  CHECK(has(text_in(error, "hint"), "echo"));

  task = both("t");
  task["pipeline"][0]["model"] = "fancy";
  error = error_body(request(task));
  CHECK(error.at("code") == "unknown_model");
  CHECK(error.at("where") == "/pipeline/0/model");
  CHECK(has(text_in(error, "hint"), "plain"));

  task = both("t");
  task["pipeline"][0]["deployment"] = "tpu";
  error = error_body(request(task));
  CHECK(error.at("code") == "unknown_deployment");
  CHECK(has(text_in(error, "hint"), "cpu-4"));

  task = both("t");
  task["pipeline"][0]["output"] = {{"protocol", "ros2"},
                                   {"endpoint", "/topic"},
                                   {"data_type", "text/plain"}};
  error = error_body(request(task));
  CHECK(error.at("code") == "schema_violation");
  CHECK(error.at("where") == "/pipeline/0/output/protocol");
  CHECK(has(text_in(error, "hint"), "file"));

  CHECK(running() == 0);
  CHECK(request(both("t")).at("type") == "task_accepted");
}

} // namespace roscell::test
