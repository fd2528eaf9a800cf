#include "actors/core/answer_limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

/// What is not stop-safe is waited for, wherever it is to end.
namespace roscell::test {

namespace {

struct not_stop_safe_cell : paper_cell {
  fake_agent& left = make_agent("left");
  fake_agent& right = make_agent("right");
  std::string instance;

  not_stop_safe_cell() {
    for (auto* x : {&left, &right}) {
      x->skills = {grasp_skill()};
      REQUIRE(enter(*x));
    }
    base.has.cpu.used = 4;
    right.has.cpu.used = 4;
    auto step = echo_step("s0", 1);
    step["operation"] = "grasp";
    REQUIRE(request(echo_task("a", {step})).at("type") == "task_accepted");
    right.has.cpu.used = 0;
    instance = left.running.begin()->first;
    left.not_stop_safe.insert(instance);
  }
};

} // namespace

TEST_CASE_METHOD(not_stop_safe_cell,
                 "A termination tells at once what it waits for, and goes on",
                 "[safe]") {
  const auto reply = request(termination("a"));
  REQUIRE(reply.at("type") == "task_terminated");
  REQUIRE(reply.at("waiting").size() == 1);
  CHECK(reply.at("waiting")[0].at("instance") == instance);
  CHECK(reply.at("waiting")[0].at("node") == "left");
  CHECK(tasks()[0].at("state") == "terminating");
  CHECK(count("instance_awaited") == 1);
  CHECK(count("task_terminated") == 0);
  // Asked again, it waits on.
  CHECK(request(termination("a")).at("waiting").size() == 1);
  time.advance(20min);
  CHECK(left.running.size() == 1);
  left.become_stop_safe(instance);
  time.settle();
  CHECK(tasks().empty());
  CHECK(count("task_terminated") == 1);
}

TEST_CASE_METHOD(not_stop_safe_cell, "Force does not wait", "[safe]") {
  SECTION("from the beginning") {
    CHECK(request(termination("a", true)).count("waiting") == 0);
  }
  SECTION("after it has waited") {
    request(termination("a"));
    request(termination("a", true));
  }
  CHECK(left.running.empty());
  CHECK(tasks().empty());
  CHECK(count("task_terminated") == 1);
}

TEST_CASE_METHOD(not_stop_safe_cell,
                 "A node that is lost while it is waited for ends it later",
                 "[safe]") {
  request(termination("a"));
  lose(left);
  CHECK(count("task_terminated") == 1);
  const auto reply = enter(left);
  REQUIRE(reply);
  CHECK(reply->verdicts.at(0).what == verdict::stop);
}

TEST_CASE_METHOD(
    not_stop_safe_cell,
    "A step that has to be stop-safe ends before its successor starts",
    "[safe]") {
  const auto reply = post({{"type", "node_release"},
                           {"node", "left"},
                           {"instances", "reschedule"}});
  time.settle();
  CHECK(right.running.empty());
  CHECK(left.running.size() == 1);
  CHECK(reply_of(reply) == nullptr);
  left.become_stop_safe(instance);
  time.settle();
  CHECK(right.running.size() == 1);
  CHECK(reply_of(reply).at("type") == "node_released");
  CHECK(count("task_failed") == 0);
  CHECK(tasks()[0].at("state") == "running");
}

TEST_CASE_METHOD(not_stop_safe_cell,
                 "What may run on is not started elsewhere when its node goes",
                 "[safe]") {
  const auto reply = post({{"type", "node_drain"}, {"node", "left"}});
  time.settle();
  CHECK(reply_of(reply).at("left").size() == 1);
  depart(left);
  time.advance(5min);
  CHECK(right.running.empty());
  const auto back = enter(left);
  REQUIRE(back);
  CHECK(back->verdicts.at(0).what == verdict::keep);
}

TEST_CASE_METHOD(
    not_stop_safe_cell,
    "What has told its end goes on elsewhere, though its node left", "[safe]") {
  post({{"type", "node_drain"}, {"node", "left"}});
  time.settle();
  left.slow_removals = true;
  left.become_stop_safe(instance);
  time.settle();
  depart(left);
  time.advance(limits::task::removal_answer + 1s);
  CHECK(right.running.size() == 1);
  CHECK(tasks()[0].at("state") == "running");
  CHECK(count("task_finished") == 0);
}

TEST_CASE_METHOD(not_stop_safe_cell,
                 "What was ended to run elsewhere and does not has failed",
                 "[safe]") {
  right.mood = temper::broken;
  post({{"type", "node_drain"}, {"node", "left"}});
  time.settle();
  left.become_stop_safe(instance);
  time.settle();
  CHECK(tasks()[0].at("state") == "failed");
  const auto reason =
      tasks()[0].at("instances")[0].at("reason").get<std::string>();
  CHECK(reason.find("it was ended to run elsewhere: ") == 0);
}

TEST_CASE_METHOD(not_stop_safe_cell,
                 "What was ended and does not start again has failed",
                 "[safe]") {
  left.not_stop_safe.clear();
  left.mood = temper::broken;
  CHECK(error_of(request({{"type", "task_restart"}, {"task", "a"}}))
        == "engine_failed");
  CHECK(tasks()[0].at("state") == "failed");
  const auto reason =
      tasks()[0].at("instances")[0].at("reason").get<std::string>();
  CHECK(reason.find("it was ended to be started again: ") == 0);
}

TEST_CASE_METHOD(not_stop_safe_cell,
                 "A node is not let go before its tasks have really ended",
                 "[safe]") {
  const auto reply = post(
      {{"type", "node_release"}, {"node", "left"}, {"instances", "terminate"}});
  time.advance(60s);
  CHECK(reply_of(reply) == nullptr);
  CHECK(left.orders.empty());
  left.become_stop_safe(instance);
  time.settle();
  CHECK(left.orders.size() == 1);
}

TEST_CASE_METHOD(not_stop_safe_cell, "A restart waits, too", "[safe]") {
  const auto reply = post({{"type", "task_restart"}, {"task", "a"}});
  time.advance(60s);
  CHECK(reply_of(reply) == nullptr);
  CHECK(left.deployments.size() == 1);
  left.become_stop_safe(instance);
  time.settle();
  CHECK(reply_of(reply).at("type") == "task_restarted");
  CHECK(left.deployments.size() == 2);
  CHECK(count("task_failed") == 0);
  CHECK(count("task_finished") == 0);
}

} // namespace roscell::test
