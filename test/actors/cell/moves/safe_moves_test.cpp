#include "actors/core/answer_limits.hpp"
#include "actors/core/limits.hpp"
#include "test/actors/fakes/careful_cell.hpp"

/// A step that has to be stop-safe ends before its successor starts, and
/// nothing else ends for it.
namespace roscell::test {

namespace {

/// Only "left" has room until the tasks run.
struct mixed_cell : careful_cell {
  void run_on_left(const json& task) {
    right.has.cpu.used = 4;
    REQUIRE(request(task).at("type") == "task_accepted");
    right.has.cpu.used = 0;
  }
};

const json drain_left{{"type", "node_drain"}, {"node", "left"}};

json release_left(const char* instances) {
  return {{"type", "node_release"}, {"node", "left"}, {"instances", instances}};
}

} // namespace

TEST_CASE_METHOD(mixed_cell,
                 "A drain lets nothing end for a step that has to be stop-safe",
                 "[moves]") {
  run_on_left(echo_task("a", {echo_step("s0", 1), grasp_step("s1")}));
  const auto safe = on(left, "s1");
  const auto plain = on(left, "s0");
  left.not_stop_safe.insert(safe);
  right.mood = temper::slow;
  request(drain_left);
  SECTION("the new ones of others run before the old ones end") {
    REQUIRE(right.starting.size() == 1);
    CHECK(right.starting[0].second.step == "s0");
    CHECK(left.running.size() == 2);
    CHECK(left.removals.empty());
    right.mood = temper::happy;
    right.finish_starting();
    time.settle();
    CHECK(on(right, "s0") != "");
    CHECK(left.running.count(plain) == 0);
    // Only now is the other one asked to go.
    CHECK(left.running.count(safe) == 1);
    CHECK(on(right, "s1").empty());
    left.become_stop_safe(safe);
    time.settle();
    CHECK(on(right, "s1") != "");
    CHECK(task_of("a").at("state") == "running");
    CHECK(count("task_failed") == 0);
  }
  SECTION("others are where they are, running, if it does not come up") {
    right.mood = temper::happy;
    right.finish_starting();
    time.settle();
    right.mood = temper::broken;
    left.become_stop_safe(safe);
    time.settle();
    const auto task = task_of("a");
    CHECK(task.at("instances")[0].at("state") == "running");
    CHECK(task.at("instances")[0].at("node") == "right");
    CHECK(task.at("instances")[1].at("state") == "failed");
    CHECK(task.at("state") == "degraded");
  }
}

TEST_CASE_METHOD(mixed_cell, "A step that finished while it moved is over",
                 "[moves]") {
  run_on_left(echo_task("a", {grasp_step("s0"), grasp_step("s1")}));
  const auto first = on(left, "s0");
  const auto second = on(left, "s1");
  left.not_stop_safe.insert(second);
  SECTION("while the places were looked for") {
    right.slow_reports = true;
    request(drain_left);
    REQUIRE(right.reports.size() == 1);
    finish(left, first);
    right.slow_reports = false;
    right.finish_reports();
    time.settle();
  }
  SECTION("while the move was written down") {
    slow_disk = true;
    post(drain_left);
    finish_writes(); // The drain.
    time.settle();
    finish(left, first);
    slow_disk = false;
    finish_writes();
    time.settle();
  }
  left.become_stop_safe(second);
  time.advance(1min);
  CHECK(on(right, "s0").empty());
  CHECK(on(right, "s1") != "");
  const auto task = task_of("a");
  CHECK(task.at("instances")[0].at("state") == "stopped");
  CHECK(task.at("state") == "running");
}

TEST_CASE_METHOD(mixed_cell,
                 "A release ends though what it ends is rolled back",
                 "[moves]") {
  right.mood = temper::slow;
  const auto placed = post(
      echo_task("a", {grasp_step("s0", "left"), echo_step("s1", 1, "right")}));
  REQUIRE(right.starting.size() == 1);
  const auto safe = on(left, "s0");
  left.not_stop_safe.insert(safe);
  right.fail_starting("no camera");
  time.settle();
  const auto reply = post(release_left("terminate"));
  CHECK(reply_of(reply) == nullptr);
  left.become_stop_safe(safe);
  time.settle();
  CHECK(reply_of(reply).at("type") == "node_released");
}

TEST_CASE_METHOD(mixed_cell, "A node that is to leave stays if that takes long",
                 "[moves]") {
  run_on_left(echo_task("a", {grasp_step("s0")}));
  const auto safe = on(left, "s0");
  left.not_stop_safe.insert(safe);
  const auto* way = GENERATE("terminate", "reschedule");
  const auto reply = post(release_left(way));
  time.advance(limits::transfer::preparing - 1s);
  time.advance(2s);
  REQUIRE(error_of(reply_of(reply)) == "timeout");
  const auto said =
      reply_of(reply).at("error").at("message").get<std::string>();
  CHECK(said.find("a/s0") != std::string::npos);
  CHECK(row("left").state == row_state::active);
  CHECK(left.orders.empty());
}

TEST_CASE_METHOD(mixed_cell,
                 "A request that failed says why, whatever it still waits for",
                 "[moves]") {
  right.mood = temper::slow;
  const auto reply = post(
      echo_task("a", {grasp_step("s0", "left"), echo_step("s1", 1, "right")}));
  REQUIRE(right.starting.size() == 1);
  left.not_stop_safe.insert(on(left, "s0"));
  right.fail_starting("no camera");
  time.settle();
  const auto answer = reply_of(reply);
  CHECK(error_of(answer) == "engine_failed");
  CHECK(answer.at("error").at("message").get<std::string>().find("no camera")
        != std::string::npos);
  // It is gone once the other one is stop-safe.
  CHECK(tasks().size() == 1);
  left.become_stop_safe(on(left, "s0"));
  time.settle();
  CHECK(tasks().empty());
}

TEST_CASE_METHOD(mixed_cell, "A wait that is told after the end is none",
                 "[moves]") {
  run_on_left(echo_task("a", {grasp_step("s0")}));
  const auto safe = on(left, "s0");
  left.not_stop_safe.insert(safe);
  left.slow_removals = true;
  const auto reply = post(termination("a"));
  auto row = left.running.at(safe);
  row.state = instance_state::stopped;
  left.report_row(row);
  time.settle();
  left.slow_removals = false;
  left.finish_removals();
  time.settle();
  left.running.erase(safe);
  time.advance(1s);
  CHECK(tasks().empty());
  CHECK(count("task_terminated") == 1);
}

TEST_CASE("A damaged record of a task is told and ends nothing", "[moves]") {
  mixed_cell before;
  before.run_on_left(echo_task("a", {echo_step("s0", 1)}));
  auto record = before.disk.at("a").get<task_record>();
  record.request = GENERATE(as<std::string>{}, "{", "", "[]", R"({"task":1})");
  paper_cell after{{record}};
  auto& left = after.make_agent("left");
  left.running = before.left.running;
  REQUIRE(after.enter(left));
  after.request(drain_left);
  after.time.advance(1s);
  CHECK(after.count("node_drain_stuck") == 1);
  CHECK(after.tasks().size() == 1);
  CHECK(
      after.request({{"type", "cell_rebalance"}, {"dry_run", true}}).at("type")
      == "cell_rebalanced");
  CHECK(error_of(after.request({{"type", "task_restart"}, {"task", "a"}}))
        == "internal");
}

TEST_CASE(
    "Orders and remains that a damaged record names start and end nothing",
    "[moves]") {
  mixed_cell before;
  before.run_on_left(echo_task("a", {echo_step("s0", 1)}));
  auto record = before.disk.at("a").get<task_record>();
  const auto running = record.specs.front().instance;
  const auto named = GENERATE(as<std::string>{}, "", "nobody");
  record.orders = {{named, "", "nothing", 1'000'000'000},
                   {named, "", "", -1'000'000'000}};
  life_policy life;
  life.on_node_loss = {loss_action::move, GENERATE(-1.0, 0.0, 1e300)};
  record.left = {{named, "s9", "nowhere", life}, {running, "s0", "left", life}};
  paper_cell after{{record}};
  auto& left = after.make_agent("left");
  left.running = before.left.running;
  REQUIRE(after.enter(left));
  after.time.advance(1h);
  CHECK(left.running.size() == 1);
  CHECK(left.running.count(running) == 1);
  CHECK(after.tasks().at(0).at("state") == "running");
}

TEST_CASE_METHOD(mixed_cell,
                 "What a node is told to stop when it registers is asked for "
                 "until it has ended",
                 "[moves]") {
  run_on_left(echo_task("a", {echo_step("s0", 1)}));
  const auto row = left.running.begin()->second;
  lose(left);
  request(termination("a"));
  const auto back = enter(left);
  REQUIRE(back);
  REQUIRE(back->verdicts.at(0).what == verdict::stop);
  // The node does not do it.
  left.removals.clear();
  left.slow_removals = true;
  time.advance(limits::retry::longest);
  CHECK(left.removals.size() == 1);
  left.slow_removals = false;
  time.advance(limits::task::removal_answer + limits::retry::longest);
  CHECK(left.running.empty());
}

} // namespace roscell::test
