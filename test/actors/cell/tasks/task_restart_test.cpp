#include "test/actors/fakes/coordinator_fakes.hpp"

/// How what has ended is started again, and what runs begins anew.
namespace roscell::test {

namespace {

struct restarting_cell : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  json body() {
    return echo_task("t",
                     {echo_step("s0", 1, "left"), echo_step("s1", 1, "right")});
  }

  static json restart_of(const std::string& instance = "") {
    json result{{"type", "task_restart"}, {"task", "t"}};
    if (!instance.empty())
      result["instance"] = instance;
    return result;
  }

  static std::string only_instance(const fake_agent& x) {
    REQUIRE(x.running.size() == 1);
    return x.running.begin()->first;
  }

  void end_only(fake_agent& x, int code) {
    auto& row = x.running.at(only_instance(x));
    row.state = code == 0 ? instance_state::stopped : instance_state::failed;
    row.exit_code = code;
    x.report_row(row);
    time.settle();
  }

  std::string state() {
    return tasks()[0].at("state");
  }
};

} // namespace

TEST_CASE_METHOD(restarting_cell,
                 "A degraded task that is sent again is healed",
                 "[task_restart]") {
  const auto first = request(body());
  const auto kept = only_instance(left);
  end_only(right, 3);
  REQUIRE(state() == "degraded");
  const auto reply = request(body());
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("healed") == json{"s1"});
  CHECK(reply.at("instances")[0] == first.at("instances")[0]);
  CHECK(reply.at("instances")[1] != first.at("instances")[1]);
  CHECK(state() == "running");
  CHECK(only_instance(left) == kept);
  CHECK(only_instance(right) == reply.at("instances")[1].at("instance"));
  CHECK(disk.at("t").count("ends") == 0);
  CHECK(count("instance_restarted") == 1);
  // Nothing is left to be healed.
  CHECK(request(body()).count("healed") == 0);
}

TEST_CASE_METHOD(restarting_cell,
                 "What has failed is healed though that is being written",
                 "[task_restart]") {
  auto document = body();
  SECTION("by a request of its own") {
    document["request_id"] = "second";
  }
  SECTION("by the same one without a name") {
    CHECK(document.count("request_id") == 0);
  }
  request(body());
  slow_disk = true;
  end_only(right, 3);
  REQUIRE_FALSE(writes.empty());
  const auto healing = post(document);
  CHECK_FALSE(*healing);
  slow_disk = false;
  finish_writes();
  time.settle();
  REQUIRE(*healing);
  CHECK(reply_of(healing).at("healed") == json{"s1"});
  CHECK(right.deployments.size() == 2);
  CHECK(state() == "running");
}

TEST_CASE_METHOD(restarting_cell,
                 "A failed task that is sent again runs, but for what is done",
                 "[task_restart]") {
  request(body());
  end_only(left, 0);
  end_only(right, 1);
  REQUIRE(state() == "failed");
  const auto reply = request(body());
  CHECK(reply.at("healed") == json{"s1"});
  CHECK(state() == "running");
  CHECK(left.deployments.size() == 1);
  CHECK(right.deployments.size() == 2);
}

TEST_CASE_METHOD(restarting_cell,
                 "What does not come up again leaves the task as it was",
                 "[task_restart]") {
  request(body());
  end_only(right, 3);
  right.mood = temper::broken;
  CHECK(error_of(request(body())) != "");
  CHECK(state() == "degraded");
  CHECK(tasks()[0].at("instances").size() == 2);
  right.mood = temper::happy;
  CHECK(request(body()).at("healed") == json{"s1"});
}

TEST_CASE_METHOD(restarting_cell, "A task is healed once at a time",
                 "[task_restart]") {
  request(body());
  end_only(right, 3);
  right.mood = temper::slow;
  const auto first = post(body());
  const auto second = post(body());
  CHECK_FALSE(*first);
  CHECK(error_of(reply_of(second)) == "conflict");
  right.finish_starting();
  time.settle();
  CHECK(reply_of(first).at("healed") == json{"s1"});
  CHECK(right.deployments.size() == 2);
}

TEST_CASE_METHOD(restarting_cell,
                 "A task terminated while it is healed leaves nothing",
                 "[task_restart]") {
  request(body());
  end_only(right, 3);
  right.mood = temper::slow;
  const auto healing = post(body());
  const auto reply = request(termination("t"));
  CHECK(reply.at("type") == "task_terminated");
  time.settle();
  CHECK(*healing);
  CHECK(left.running.empty());
  CHECK(disk.empty());
  CHECK(tasks().empty());
}

TEST_CASE_METHOD(restarting_cell,
                 "A restarted instance ends before it begins on its node",
                 "[task_restart]") {
  request(body());
  const auto old = only_instance(right);
  const auto kept = only_instance(left);
  const auto reply = request(restart_of(old));
  REQUIRE(reply.at("type") == "task_restarted");
  REQUIRE(reply.at("instances").size() == 1);
  CHECK(reply.at("instances")[0].at("node") == "right");
  CHECK(right.removals.front().instance == old);
  CHECK(only_instance(right) == reply.at("instances")[0].at("instance"));
  CHECK(only_instance(left) == kept);
  CHECK(state() == "running");
}

TEST_CASE_METHOD(restarting_cell, "A restarted task begins anew as a whole",
                 "[task_restart]") {
  request(body());
  const auto reply = request(restart_of());
  REQUIRE(reply.at("type") == "task_restarted");
  CHECK(reply.at("instances").size() == 2);
  CHECK(left.deployments.size() == 2);
  CHECK(right.deployments.size() == 2);
  CHECK(state() == "running");
  CHECK(disk.at("t").at("specs").size() == 2);
}

TEST_CASE_METHOD(restarting_cell, "A restart needs the room only once",
                 "[task_restart]") {
  request(echo_task("t", {echo_step("s0", 4, "left")}));
  left.has.cpu.used = 0;
  CHECK(request(restart_of()).at("type") == "task_restarted");
}

TEST_CASE_METHOD(restarting_cell, "What is away or unknown is not restarted",
                 "[task_restart]") {
  CHECK(error_of(request(restart_of())) == "unknown_task");
  request(body());
  CHECK(error_of(request(restart_of("t-s9-00000000"))) == "unknown_task");
  lose(right);
  CHECK(error_of(request(restart_of())) == "conflict");
  CHECK(left.removals.empty());
  CHECK(request(restart_of(only_instance(left))).at("type")
        == "task_restarted");
}

} // namespace roscell::test
