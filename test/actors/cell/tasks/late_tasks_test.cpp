#include "test/actors/fakes/careful_cell.hpp"

/// Tasks that run for longer than their `timeout_s`.
namespace roscell::test {

namespace {

struct hasty_cell : careful_cell {
  /// Task "a" has a minute.
  void run_a(const std::vector<json>& steps) {
    auto document = echo_task("a", steps);
    document["timeout_s"] = 60;
    REQUIRE(request(document).at("type") == "task_accepted");
  }

  std::string state_of_a() {
    return task_of("a").at("state").get<std::string>();
  }

  json first_instance() {
    return task_of("a").at("instances").at(0);
  }
};

} // namespace

TEST_CASE_METHOD(hasty_cell,
                 "A task whose time is over is ended, has failed, and says why",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left"), echo_step("s1", 1, "right")});
  CHECK(task_of("a").at("deadline_unix_ms") > 0);
  time.advance(59s);
  CHECK(state_of_a() == "running");
  time.advance(2s);
  CHECK(left.running.empty());
  CHECK(right.running.empty());
  CHECK(state_of_a() == "failed");
  CHECK(first_instance().at("reason") == "the task's timeout_s of 60 is over");
  CHECK_FALSE(task_of("a").contains("deadline_unix_ms"));
  CHECK(count("task_timed_out") == 1);
  CHECK(count("task_failed") == 1);
  const auto asked = left.removals.size();
  time.advance(10min);
  CHECK(left.removals.size() == asked);
}

TEST_CASE_METHOD(hasty_cell, "A task that has ended in time is left alone",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left")});
  finish(left, on(left, "s0"));
  time.advance(2min);
  CHECK(state_of_a() == "finished");
  CHECK(count("task_timed_out") == 0);
}

TEST_CASE_METHOD(hasty_cell, "A task without a timeout_s runs for ever",
                 "[late_tasks]") {
  auto document = echo_task("a", {echo_step("s0", 1, "left")});
  document["timeout_s"] = 0;
  REQUIRE(request(document).at("type") == "task_accepted");
  time.advance(24h);
  CHECK(state_of_a() == "running");
}

TEST_CASE_METHOD(hasty_cell,
                 "What of a late task is not stop-safe is waited "
                 "for",
                 "[late_tasks]") {
  run_a({grasp_step("s0", "left")});
  const auto instance = on(left, "s0");
  left.not_stop_safe.insert(instance);
  time.advance(5min);
  CHECK(left.running.count(instance) == 1);
  CHECK(state_of_a() != "failed");
  CHECK(error_of(request({{"type", "task_restart"}, {"task", "a"}}))
        == "conflict");
  left.become_stop_safe(instance);
  time.settle();
  CHECK(state_of_a() == "failed");
}

TEST_CASE_METHOD(hasty_cell,
                 "What of a late task is on a node that is away is "
                 "ended when that is back",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left"), echo_step("s1", 1, "right")});
  lose(left);
  time.advance(5min);
  CHECK(right.running.empty());
  CHECK(state_of_a() != "failed");
  REQUIRE(enter(left));
  time.advance(1s);
  CHECK(left.running.empty());
  CHECK(state_of_a() == "failed");
}

TEST_CASE_METHOD(hasty_cell,
                 "What of a late task was lost is not placed anew, and has "
                 "ended with its fence",
                 "[late_tasks]") {
  auto step = echo_step("s0", 1);
  step["on_node_loss"] = {{"policy", "move"}, {"after_s", 30}};
  right.has.cpu.used = 4;
  run_a({step});
  REQUIRE(left.running.size() == 1);
  right.has.cpu.used = 0;
  time.advance(40s);
  lose(left);
  time.advance(25s);
  CHECK(state_of_a() != "failed");
  time.advance(1min);
  CHECK(right.deployments.empty());
  CHECK(state_of_a() == "failed");
}

TEST_CASE_METHOD(hasty_cell, "What runs of a late task stays where it is",
                 "[late_tasks]") {
  run_a({grasp_step("s0", "left")});
  left.not_stop_safe.insert(on(left, "s0"));
  time.advance(61s);
  request({{"type", "node_drain"}, {"node", "left"}});
  time.advance(1min);
  CHECK(right.running.empty());
  CHECK(left.running.size() == 1);
}

TEST_CASE_METHOD(hasty_cell,
                 "A coordinator that was killed ends a task at the "
                 "same time",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left")});
  begin_anew();
  REQUIRE(enter(left));
  REQUIRE(enter(right));
  time.advance(50s);
  CHECK(left.running.size() == 1);
  time.advance(1min);
  CHECK(left.running.empty());
  CHECK(state_of_a() == "failed");
}

TEST_CASE_METHOD(hasty_cell,
                 "A coordinator that was killed while it ended a "
                 "late task goes on with that",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left")});
  left.slow_removals = true;
  time.advance(61s);
  // The time that is written down is that of the wall, which stands still here.
  disk.at("a")["deadline_unix_ms"] = 1;
  begin_anew();
  left.slow_removals = false;
  REQUIRE(enter(left));
  time.advance(1s);
  CHECK(left.running.empty());
  CHECK(state_of_a() == "failed");
  CHECK(left.deployments.size() == 1);
}

TEST_CASE_METHOD(hasty_cell,
                 "What was told to end before is not started again "
                 "for a late task",
                 "[late_tasks]") {
  run_a({echo_step("s0", 4, "left")});
  auto urgent = echo_step("s0", 4, "left");
  urgent["priority"] = 9;
  auto document = echo_task("b", {urgent});
  document["preempt"] = "yes";
  REQUIRE(request(document).at("type") == "task_accepted");
  time.advance(61s);
  CHECK(state_of_a() == "failed");
  request(termination("b"));
  time.advance(10min);
  CHECK(left.running.empty());
}

TEST_CASE_METHOD(hasty_cell,
                 "A late task that is started again has its whole "
                 "time",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left")});
  time.advance(61s);
  REQUIRE(state_of_a() == "failed");
  REQUIRE(request({{"type", "task_restart"}, {"task", "a"}}).at("type")
          == "task_restarted");
  time.advance(59s);
  CHECK(state_of_a() == "running");
  time.advance(2s);
  CHECK(state_of_a() == "failed");
  CHECK(count("task_timed_out") == 2);
}

TEST_CASE_METHOD(hasty_cell, "The next run of a task has its whole time",
                 "[late_tasks]") {
  auto document = echo_task("a", {echo_step("s0", 1, "left")});
  document["timeout_s"] = 60;
  for (const auto* id : {"first", "second"}) {
    document["request_id"] = id;
    REQUIRE(request(document).at("type") == "task_accepted");
    time.advance(59s);
    CHECK(left.running.size() == 1);
    time.advance(2s);
    CHECK(state_of_a() == "failed");
  }
}

TEST_CASE_METHOD(hasty_cell, "A late task can be terminated meanwhile",
                 "[late_tasks]") {
  run_a({grasp_step("s0", "left")});
  left.not_stop_safe.insert(on(left, "s0"));
  time.advance(61s);
  CHECK(request(termination("a", true)).at("type") == "task_terminated");
  CHECK(left.running.empty());
  CHECK(disk.empty());
}

TEST_CASE_METHOD(hasty_cell,
                 "A node that does not remove what is late is asked "
                 "again",
                 "[late_tasks]") {
  run_a({echo_step("s0", 1, "left")});
  left.slow_removals = true;
  time.advance(61s);
  left.fail_removals();
  left.slow_removals = false;
  time.advance(2min);
  CHECK(left.running.empty());
  CHECK(state_of_a() == "failed");
}

} // namespace roscell::test
