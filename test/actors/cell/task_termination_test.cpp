#include "actors/core/answer_limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

namespace roscell::test {

namespace {

struct two_nodes : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  json both() {
    return echo_task("t",
                     {echo_step("s0", 3, "left"), echo_step("s1", 3, "right")});
  }
};

} // namespace

TEST_CASE_METHOD(two_nodes, "Termination removes a task's instances everywhere",
                 "[task_termination]") {
  request(echo_task("other", {echo_step("s0", 1, "left")}));
  const auto accepted = request(both());
  const auto reply = request(termination("t"));
  REQUIRE(reply.at("type") == "task_terminated");
  CHECK(reply.at("instances").size() == 2);
  CHECK(reply.at("instances")[0] == accepted.at("instances")[0].at("instance"));
  CHECK(reply.count("pending_nodes") == 0);
  CHECK(left.running.size() == 1);
  CHECK(right.running.empty());
  CHECK(row("right").instances.empty());
  CHECK(row("left").instances.size() == 1);
  CHECK(tasks().size() == 1);
  CHECK(disk.size() == 1);
  CHECK(count("task_terminated") == 1);
  // The resources are free.
  CHECK(request(both()).at("type") == "task_accepted");
}

TEST_CASE_METHOD(two_nodes, "A repeated termination gets the same answer",
                 "[task_termination]") {
  request(both());
  const auto reply = request(termination("t"));
  CHECK(request(termination("t")) == reply);
  CHECK(left.removals.size() == 1);
}

TEST_CASE_METHOD(two_nodes,
                 "A termination that is repeated meanwhile waits for the first",
                 "[task_termination]") {
  request(both());
  left.slow_removals = true;
  const auto first = post(termination("t"));
  const auto second = post(termination("t"));
  CHECK_FALSE(*first);
  CHECK(tasks()[0].at("state") == "terminating");
  CHECK(error_of(request(both())) == "conflict");
  left.finish_removals();
  time.settle();
  CHECK(reply_of(first).at("type") == "task_terminated");
  CHECK(reply_of(second) == reply_of(first));
  CHECK(left.removals.size() == 1);
}

TEST_CASE_METHOD(two_nodes,
                 "A termination that is repeated by force leaves no more time "
                 "to what ends politely",
                 "[task_termination]") {
  request(both());
  left.slow_removals = right.slow_removals = true;
  const auto first = post(termination("t"));
  auto forced = termination("t");
  forced["force"] = true;
  const auto second = post(forced);
  REQUIRE(left.removals.size() == 2);
  CHECK_FALSE(left.removals[0].force);
  CHECK(left.removals[1].force);
  CHECK(right.removals.back().force);
  left.finish_removals();
  right.finish_removals();
  time.settle();
  CHECK(reply_of(first).at("type") == "task_terminated");
  CHECK(reply_of(second) == reply_of(first));
}

TEST_CASE_METHOD(two_nodes,
                 "A task whose request was refused is none to be terminated",
                 "[task_termination]") {
  slow_disk = true;
  const auto refused = post(
      echo_task("t", {echo_step("s0", 3, "left"), echo_step("s1", 3, "left")}));
  // Whoever hears of the refusal finds that there is no such task.
  CHECK_FALSE(*refused);
  finish_writes();
  time.settle();
  CHECK(error_of(reply_of(refused)) == "no_feasible_allocation");
  CHECK(error_of(request(termination("t"))) == "unknown_task");
  CHECK(count("task_terminated") == 0);
}

TEST_CASE_METHOD(two_nodes, "A task that was never there cannot be terminated",
                 "[task_termination]") {
  const auto reply = request(termination("t"));
  CHECK(error_of(reply) == "unknown_task");
  CHECK(reply.at("error").at("where") == "/task");
}

TEST_CASE_METHOD(two_nodes, "A task that runs again is terminated again",
                 "[task_termination]") {
  request(both());
  const auto first = request(termination("t"));
  request(both());
  const auto second = request(termination("t"));
  CHECK(second.at("instances") != first.at("instances"));
  CHECK(left.running.empty());
}

TEST_CASE_METHOD(two_nodes, "A task can be terminated while it is deployed",
                 "[task_termination]") {
  right.mood = temper::slow;
  const auto first = post(both());
  const auto second = post(both());
  const auto reply = request(termination("t"));
  CHECK(reply.at("type") == "task_terminated");
  CHECK(reply.at("instances").size() == 2);
  CHECK(error_of(reply_of(first)) == "conflict");
  CHECK(error_of(reply_of(second)) == "conflict");
  CHECK(left.running.empty());
  CHECK(right.running.empty());
  CHECK(tasks().empty());
  CHECK(disk.empty());
  right.mood = temper::happy;
  CHECK(request(both()).at("type") == "task_accepted");
}

TEST_CASE_METHOD(two_nodes,
                 "A task can be terminated before its nodes are chosen",
                 "[task_termination]") {
  left.slow_reports = true;
  const auto first = post(both());
  CHECK_FALSE(*first);
  const auto reply = request(termination("t"));
  CHECK(reply.at("type") == "task_terminated");
  CHECK(reply.at("instances").empty());
  left.slow_reports = false;
  left.finish_reports();
  time.settle();
  CHECK(error_of(reply_of(first)) == "conflict");
  CHECK(left.deployments.empty());
  CHECK(right.deployments.empty());
  CHECK(request(both()).at("type") == "task_accepted");
}

TEST_CASE_METHOD(two_nodes, "No instance comes up after its task's termination",
                 "[task_termination]") {
  // Whatever has been handled when the termination comes, nothing may be left.
  for (size_t handled = 0; handled < 60; ++handled) {
    const auto first =
        time.ask<request_routed>(router, route_request{both().dump()});
    for (size_t i = 0; i < handled && time.scheduler.has_job(); ++i)
      time.scheduler.run_once();
    const auto end =
        time.ask<task_terminated>(coordinator, task_termination{"t"});
    time.settle();
    CAPTURE(handled);
    REQUIRE(*first);
    REQUIRE(*end);
    if (error_of(reply_of(first)).empty())
      request(termination("t"));
    CHECK(left.running.empty());
    CHECK(right.running.empty());
    CHECK(tasks().empty());
    CHECK(disk.empty());
  }
}

TEST_CASE_METHOD(two_nodes,
                 "A pipeline that is killed at any moment leaves nothing",
                 "[task_termination]") {
  for (size_t handled = 0; handled < 60; ++handled) {
    right.deployer = nullptr;
    right.mood = temper::slow;
    const auto first =
        time.ask<request_routed>(router, route_request{both().dump()});
    for (size_t i = 0; i < handled && time.scheduler.has_job(); ++i)
      time.scheduler.run_once();
    CAPTURE(handled);
    if (right.deployer) {
      time.kill(right.deployer);
    } else {
      time.settle();
      REQUIRE(right.deployer);
      time.kill(right.deployer);
    }
    REQUIRE(*first);
    CHECK(error_of(reply_of(first)) == "internal");
    CHECK(left.running.empty());
    CHECK(right.running.empty());
    CHECK(tasks().empty());
    CHECK(disk.empty());
  }
}

TEST_CASE_METHOD(two_nodes,
                 "A node that is away ends its instances when it is back",
                 "[task_termination]") {
  const auto accepted = request(both());
  lose(right);
  const auto reply = request(termination("t"));
  CHECK(reply.at("pending_nodes") == json{"right"});
  CHECK(left.running.empty());
  CHECK(tasks().empty());
  CHECK(disk.empty());

  ++right.identity.epoch;
  const auto registered = enter(right);
  REQUIRE(registered);
  REQUIRE(registered->verdicts.size() == 1);
  CHECK(registered->verdicts[0].instance
        == accepted.at("instances")[1].at("instance"));
  CHECK(registered->verdicts[0].what == verdict::stop);
  // It is there until the node has ended it.
  REQUIRE(row("right").instances.size() == 1);
  auto ended = row("right").instances[0];
  ended.state = instance_state::stopped;
  right.report_row(ended);
  time.settle();
  CHECK(row("right").instances.empty());
}

TEST_CASE_METHOD(two_nodes,
                 "A node that does not end its instances in time is pending",
                 "[task_termination]") {
  request(both());
  right.slow_removals = true;
  const auto reply = post(termination("t"));
  time.advance(limits::task::removal_answer - 1s);
  CHECK_FALSE(*reply);
  time.advance(2s);
  REQUIRE(*reply);
  CHECK(reply_of(reply).at("pending_nodes") == json{"right"});
}

} // namespace roscell::test
