#include "actors/cell/limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

/// How tasks end by themselves, and what is remembered of it.
namespace roscell::test {

namespace {

struct one_arm : paper_cell {
  fake_agent& arm = add("arm");

  /// All that runs there ends, and the node tells of it.
  void end_all(fake_agent& x, int code = 0) {
    for (auto& [id, row] : x.running)
      end(x, id, code);
    time.settle();
  }

  static void end(fake_agent& x, const std::string& id, int code) {
    auto& row = x.running.at(id);
    row.state = code == 0 ? instance_state::stopped : instance_state::failed;
    row.exit_code = code;
    row.since_unix_ms = 1234;
    x.report_row(row);
  }

  json accept(const std::string& task, const std::vector<json>& steps) {
    auto reply = request(echo_task(task, steps));
    REQUIRE(reply.at("type") == "task_accepted");
    return reply;
  }

  json task(const std::string& id) {
    const auto reply = request({{"type", "task_query"}, {"task", id}});
    REQUIRE(reply.at("type") == "task_description");
    return reply.at("tasks")[0];
  }
};

/// A record of a task with a step on "arm" that ended with 0.
task_record ended_record() {
  return with_ends(kept_record({echo_instance("t-on-arm")}, {"arm"}),
                   {{"t-on-arm", instance_state::stopped, 0, "", 9}}, 9);
}

} // namespace

TEST_CASE_METHOD(one_arm,
                 "A task whose steps have all ended with 0 is finished",
                 "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm"), echo_step("s1", 3, "arm")});
  end(arm, arm.running.begin()->first, 0);
  time.settle();
  CHECK(task("t").at("state") == "running");
  end_all(arm);
  CHECK(task("t").at("state") == "finished");
  CHECK(disk.at("t").at("state") == "finished");
  CHECK(disk.at("t").at("ends").size() == 2);
  CHECK(count("task_finished") == 1);
}

TEST_CASE_METHOD(one_arm, "A finished task holds no resources and no node",
                 "[task_end]") {
  accept("t", {echo_step("s0", 4, "arm")});
  end_all(arm);
  arm.running.clear();
  accept("u", {echo_step("s0", 4, "arm")});
  request(termination("u"));
  const auto reply = request(
      {{"type", "node_release"}, {"node", "arm"}, {"instances", "refuse"}});
  CHECK(reply.at("type") == "node_released");
}

TEST_CASE_METHOD(one_arm,
                 "A task has failed when all of it has ended, not all with 0",
                 "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1, "arm")});
  end(arm, arm.running.begin()->first, 3);
  time.settle();
  CHECK(task("t").at("state") == "degraded");
  end(arm, arm.running.rbegin()->first, 0);
  time.settle();
  CHECK(task("t").at("state") == "failed");
  CHECK(count("task_failed") == 1);
}

TEST_CASE_METHOD(one_arm,
                 "What has ended is not started again when its node forgets it",
                 "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1, "arm")});
  end(arm, arm.running.begin()->first, 0);
  time.settle();
  arm.running.erase(arm.running.begin());
  lose(arm);
  ++arm.identity.epoch;
  const auto reply = enter(arm);
  REQUIRE(reply);
  for (const auto& x : reply->verdicts)
    CHECK(x.what == verdict::keep);
  CHECK(reply->verdicts.size() == 1);
}

TEST_CASE_METHOD(one_arm,
                 "An end that came while the node was away is taken up",
                 "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm")});
  lose(arm);
  auto& row = arm.running.begin()->second;
  row.state = instance_state::stopped;
  row.exit_code = 0;
  ++arm.identity.epoch;
  REQUIRE(enter(arm));
  CHECK(task("t").at("state") == "finished");
  CHECK(disk.at("t").at("state") == "finished");
}

TEST_CASE("A restarted coordinator starts nothing that has ended",
          "[task_end]") {
  paper_cell cell{{ended_record()}};
  auto& arm = cell.make_agent("arm");
  const auto reply = cell.enter(arm);
  REQUIRE(reply);
  CHECK(reply->verdicts.empty());
  CHECK(cell.tasks()[0].at("state") == "finished");
  CHECK(cell.tasks()[0].at("instances")[0].at("exit_code") == 0);
}

TEST_CASE_METHOD(one_arm, "A finished task asked for again runs nothing anew",
                 "[task_end]") {
  const auto first = accept("t", {echo_step("s0", 1, "arm")});
  end_all(arm);
  const auto again = request(echo_task("t", {echo_step("s0", 1, "arm")}));
  CHECK(again.at("found") == "finished");
  CHECK(placement_in(again) == placement_in(first));
  CHECK(arm.deployments.size() == 1);
  // It is there until it is terminated.
  CHECK(request(termination("t")).at("type") == "task_terminated");
  CHECK(disk.empty());
}

TEST_CASE_METHOD(one_arm, "A step that ends before the others run is known",
                 "[task_end]") {
  base.mood = temper::slow;
  const auto reply = post(
      echo_task("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1, "base")}));
  end_all(arm);
  CHECK_FALSE(*reply);
  base.finish_starting();
  time.settle();
  CHECK(reply_of(reply).at("type") == "task_accepted");
  CHECK(disk.at("t").at("ends").size() == 1);
  end_all(base);
  CHECK(task("t").at("state") == "finished");
}

TEST_CASE_METHOD(one_arm, "The oldest of too many finished tasks goes",
                 "[task_end]") {
  for (size_t i = 0; i <= limits::task::settled; ++i) {
    time.advance(1ms);
    accept("t" + std::to_string(i), {echo_step("s0", 1, "arm")});
    end_all(arm);
    arm.running.clear();
  }
  CHECK(tasks().size() == limits::task::settled);
  CHECK(disk.size() == limits::task::settled);
  CHECK(arm.removals.size() == 1);
}

TEST_CASE_METHOD(one_arm, "A node's word changes its own instances only",
                 "[task_end]") {
  auto& leg = add("leg");
  accept("t", {echo_step("s0", 1, "arm")});
  auto row = arm.running.begin()->second;
  row.state = instance_state::failed;
  row.exit_code = 1;
  // With the other node's name, and with its own.
  leg.report_row(row);
  row.node = "leg";
  leg.report_row(row);
  time.settle();
  CHECK(task("t").at("state") == "running");
  CHECK(task("t").at("instances")[0].at("state") == "running");
  CHECK(task("t").at("instances")[0].at("node") == "arm");
  row.state = instance_state::stopped;
  row.spec.task = "another";
  leg.report_row(row);
  time.settle();
  CHECK(this->row("arm").instances.size() == 1);
}

TEST_CASE_METHOD(one_arm, "What a lost node runs is not known", "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm")});
  CHECK(task("t").at("instances")[0].count("unknown_since_unix_ms") == 0);
  lose(arm);
  const auto since = row("arm").since_unix_ms;
  CHECK(task("t").at("state") == "degraded");
  CHECK(task("t").at("instances")[0].at("unknown_since_unix_ms") == since);
  const auto shown = request({{"type", "instance_query"}}).at("instances");
  REQUIRE(shown.size() == 1);
  CHECK(shown[0].at("unknown_since_unix_ms") == since);
  ++arm.identity.epoch;
  REQUIRE(enter(arm));
  CHECK(task("t").at("state") == "running");
  CHECK(task("t").at("instances")[0].count("unknown_since_unix_ms") == 0);
}

TEST_CASE_METHOD(one_arm, "How a lost node's instance ended is known",
                 "[task_end]") {
  accept("t", {echo_step("s0", 1, "arm")});
  end_all(arm);
  lose(arm);
  CHECK(task("t").at("state") == "finished");
  CHECK(task("t").at("instances")[0].count("unknown_since_unix_ms") == 0);
}

} // namespace roscell::test
