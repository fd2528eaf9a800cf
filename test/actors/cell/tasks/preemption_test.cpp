#include "actors/core/answer_limits.hpp"
#include "test/actors/fakes/careful_cell.hpp"

/// What runs is preempted for tasks of higher priority, if somebody says so.
namespace roscell::test {

namespace {

/// Task "low" fills node "left"; "right" and the coordination node are full of
/// other programs.
struct full_cell : careful_cell {
  full_cell() {
    right.has.cpu.used = 4;
    REQUIRE(request(low()).at("type") == "task_accepted");
    REQUIRE(left.running.size() == 1);
  }

  static json low() {
    auto step = echo_step("s0", 4);
    step["priority"] = 2;
    step["operation"] = "grasp";
    return echo_task("low", {step});
  }

  static json high(const char* preempt, int priority = 8) {
    auto step = echo_step("s0", 3);
    step["priority"] = priority;
    auto result = echo_task("high", {step});
    result["preempt"] = preempt;
    return result;
  }

  json of_task(const std::string& task) {
    return request({{"type", "task_query"}, {"task", task}}).at("tasks").at(0);
  }

  std::string low_instance() {
    return left.running.begin()->first;
  }
};

} // namespace

TEST_CASE_METHOD(full_cell,
                 "A refusal names what would have to go, and nothing goes",
                 "[preempt]") {
  const auto reply = request(high("show"));
  REQUIRE(error_of(reply) == "no_feasible_allocation");
  const auto& named = reply.at("error").at("preempted");
  REQUIRE(named.size() == 1);
  CHECK(named[0].at("task") == "low");
  CHECK(named[0].at("node") == "left");
  CHECK(named[0].at("priority") == 2);
  CHECK(left.running.size() == 1);
  CHECK(left.removals.empty());
  CHECK(of_task("low").at("state") == "running");
}

TEST_CASE_METHOD(full_cell, "Who does not ask for it is told that it is there",
                 "[preempt]") {
  const auto reply = request(high("none"));
  REQUIRE(error_of(reply) == "no_feasible_allocation");
  CHECK(reply.at("error").at("hint").get<std::string>().find("--preempt")
        != std::string::npos);
  CHECK(reply.at("error").count("preempted") == 0);
}

TEST_CASE_METHOD(full_cell, "Equal priority makes nobody go", "[preempt]") {
  const auto reply = request(high("yes", 2));
  CHECK(error_of(reply) == "no_feasible_allocation");
  CHECK(reply.at("error").count("rejected") == 1);
  CHECK(left.running.size() == 1);
}

TEST_CASE_METHOD(full_cell, "What goes ends, and its task knows why",
                 "[preempt]") {
  const auto reply = request(high("yes"));
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("preempted")[0].at("task") == "low");
  CHECK(reply.at("instances")[0].at("node") == "left");
  time.settle();
  const auto low_task = of_task("low");
  CHECK(low_task.at("state") == "failed");
  CHECK(low_task.at("instances")[0].at("reason")
        == "it is preempted by task 'high'");
  CHECK(count("instance_preempted") == 1);
  CHECK(count("step_stranded") == 1);
  SECTION("and starts again when it is asked for and there is room") {
    request(termination("high"));
    const auto again = request(low());
    CHECK(again.at("healed") == json{"s0"});
    CHECK(of_task("low").at("state") == "running");
  }
  SECTION("and the same request again changes nothing") {
    for (const auto* way : {"none", "show", "yes"})
      CHECK(request(high(way)).at("preempted")[0].at("task") == "low");
    CHECK(left.deployments.size() == 2);
  }
}

TEST_CASE_METHOD(full_cell,
                 "What goes is started elsewhere where there is room",
                 "[preempt]") {
  right.has.cpu.used = 0;
  auto asked = high("yes");
  asked["pipeline"][0]["labels"] = {{"node", "left"}};
  left.has.labels["node"] = "left";
  REQUIRE(request(asked).at("type") == "task_accepted");
  time.settle();
  CHECK(of_task("low").at("state") == "running");
  CHECK(of_task("low").at("instances")[0].at("node") == "right");
  CHECK(count("instance_moved") == 1);
}

TEST_CASE_METHOD(full_cell, "What has to be stop-safe is waited for",
                 "[preempt]") {
  const auto instance = low_instance();
  left.not_stop_safe.insert(instance);
  const auto reply = post(high("yes"));
  time.advance(60s);
  REQUIRE(reply_of(reply) == nullptr);
  CHECK(of_task("high").at("state") == "deploying");
  CHECK(left.deployments.size() == 1);
  SECTION("until it is, and others place their tasks meanwhile") {
    right.has.cpu.used = 0;
    CHECK(request(echo_task("other", {echo_step("s0", 1)})).at("type")
          == "task_accepted");
    left.become_stop_safe(instance);
    time.settle();
    CHECK(reply_of(reply).at("type") == "task_accepted");
  }
  SECTION("or until the time is over, and it starts again when it has ended") {
    time.advance(limits::task::eviction);
    CHECK(error_of(reply_of(reply)) == "timeout");
    CHECK(of_task("low").at("state") == "running");
    left.become_stop_safe(instance);
    time.settle();
    CHECK(of_task("low").at("state") == "running");
    CHECK(left.deployments.size() == 2);
  }
  SECTION("or until nobody wants the task any more") {
    request(termination("high"));
    left.become_stop_safe(instance);
    time.settle();
    CHECK(of_task("low").at("state") == "running");
    CHECK(left.running.size() == 1);
  }
}

TEST_CASE_METHOD(full_cell, "Force waits for nothing", "[preempt]") {
  left.not_stop_safe.insert(low_instance());
  auto asked = high("yes");
  asked["force"] = true;
  CHECK(request(asked).at("type") == "task_accepted");
}

TEST_CASE_METHOD(full_cell,
                 "What has gone comes back when the task does not come up",
                 "[preempt]") {
  SECTION("because its step breaks") {
    const auto instance = low_instance();
    left.not_stop_safe.insert(instance);
    const auto reply = post(high("yes"));
    time.settle();
    left.mood = temper::broken;
    left.become_stop_safe(instance);
    time.settle();
    CHECK(error_of(reply_of(reply)) == "engine_failed");
    CHECK(of_task("low").at("state") == "failed");
    left.mood = temper::happy;
    CHECK(request(low()).at("healed") == json{"s0"});
  }
  SECTION("because its node has no room after all") {
    left.reluctance = 1;
    CHECK(error_of(request(high("yes"))) == "no_feasible_allocation");
    time.settle();
    CHECK(of_task("low").at("state") == "running");
    CHECK(left.running.size() == 1);
  }
}

TEST_CASE_METHOD(full_cell,
                 "What may run on is not taken for gone, nor started elsewhere",
                 "[preempt]") {
  left.not_stop_safe.insert(low_instance());
  const auto reply = post(high("yes"));
  time.settle();
  right.has.cpu.used = 0;
  lose(left);
  time.settle();
  CHECK_FALSE(error_of(reply_of(reply)).empty());
  CHECK(right.running.empty());
  CHECK(of_task("low").at("state") == "degraded");
  const auto back = enter(left);
  REQUIRE(back);
  CHECK(back->verdicts.at(0).what == verdict::keep);
}

/// The same cell, whose coordinator has begun anew.
struct again_cell : paper_cell {
  fake_agent& left = make_agent("left");

  explicit again_cell(const full_cell& before)
      : paper_cell(records_of(before)) {
    left.skills = {echo_skill(), grasp_skill()};
    left.running = before.left.running;
    base.has.cpu.used = 4;
  }

  static std::vector<task_record> records_of(const full_cell& before) {
    std::vector<task_record> result;
    for (const auto& [task, record] : before.disk)
      result.push_back(record.get<task_record>());
    return result;
  }

  json low() {
    return request({{"type", "task_query"}, {"task", "low"}}).at("tasks").at(0);
  }
};

TEST_CASE_METHOD(
    full_cell,
    "What was told to end for another task has not finished, though the "
    "coordinator began anew",
    "[preempt]") {
  const auto instance = low_instance();
  left.not_stop_safe.insert(instance);
  post(high("yes"));
  time.advance(1s);
  left.running.at(instance).unsafe_since_unix_ms = 1;
  again_cell after{*this};
  REQUIRE(after.enter(after.left));
  after.time.settle();
  CHECK(after.tasks().size() == 1);
  auto row = after.left.running.at(instance);
  after.left.running.erase(instance);
  row.state = instance_state::stopped;
  row.exit_code = 0;
  SECTION("there is room again") {
    after.left.report_row(row);
    after.time.advance(1min);
    CHECK(after.low().at("state") == "running");
    CHECK(after.left.running.size() == 1);
  }
  SECTION("there is none") {
    after.left.has.cpu.used = 4;
    after.left.report_row(row);
    after.time.advance(10min);
    CHECK(after.low().at("state") == "failed");
    CHECK(after.low().at("instances")[0].at("reason")
          == "it is preempted by task 'high'");
    CHECK(after.count("step_stranded") == 1);
  }
  CHECK(after.count("task_finished") == 0);
}

TEST_CASE_METHOD(
    full_cell,
    "What was preempted comes back, though the coordinator began anew",
    "[preempt]") {
  left.mood = temper::slow;
  post(high("yes"));
  time.settle();
  REQUIRE(left.starting.size() == 1);
  REQUIRE(of_task("low").at("state") == "failed");
  again_cell after{*this};
  after.left.running.clear();
  after.time.advance(10s);
  REQUIRE(after.enter(after.left));
  after.time.advance(1min);
  CHECK(after.low().at("state") == "running");
  CHECK(after.left.running.size() == 1);
}

TEST_CASE_METHOD(full_cell, "A plan shows what would have to go", "[preempt]") {
  auto query = high("none");
  query["type"] = "task_plan_query";
  query.erase("preempt");
  CHECK(error_of(request(query)) == "no_feasible_allocation");
  query["preempt"] = true;
  const auto plan = request(query);
  REQUIRE(plan.at("type") == "task_plan");
  CHECK(plan.at("preempted")[0].at("task") == "low");
  CHECK(left.running.size() == 1);
}

} // namespace roscell::test
