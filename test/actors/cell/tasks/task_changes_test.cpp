#include "actors/core/answer_limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

#include "test/words.hpp"

/// What is answered when the store cannot keep a task, and when a node or the
/// coordinator itself does not go on.
namespace roscell::test {

namespace {

struct two_arms : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  json both() {
    return echo_task("t",
                     {echo_step("s0", 3, "left"), echo_step("s1", 3, "right")});
  }

  size_t running() const {
    return left.running.size() + right.running.size();
  }
};

std::string message_of(const json& reply) {
  REQUIRE(error_of(reply) != "");
  return reply.at("error").at("message").get<std::string>();
}

using roscell::test::has;

} // namespace

TEST_CASE_METHOD(two_arms, "A task that cannot be stored is refused",
                 "[task_changes]") {
  disk_full = true;
  const auto reply = request(both());
  CHECK(has(message_of(reply), "the disk is full"));
  CHECK(has(reply.at("error").at("hint").get<std::string>(), "make room"));
  CHECK(left.deployments.empty());
  CHECK(right.deployments.empty());
  CHECK(tasks().empty());
  CHECK(count("task_accepted") == 0);
  // The room that nodes keep is given up.
  CHECK(left.removals.size() == 1);
  disk_full = false;
  CHECK(request(both()).at("type") == "task_accepted");
}

TEST_CASE_METHOD(two_arms, "A task that runs and cannot be stored is undone",
                 "[task_changes]") {
  right.mood = temper::slow;
  const auto first = post(both());
  const auto second = post(both());
  disk_full = true;
  right.finish_starting();
  time.settle();
  CHECK(has(message_of(reply_of(first)), "the disk is full"));
  CHECK(has(message_of(reply_of(second)), "the disk is full"));
  CHECK(running() == 0);
  CHECK(tasks().empty());
  CHECK(count("task_accepted") == 0);
  disk_full = false;
  right.mood = temper::happy;
  CHECK(request(both()).at("type") == "task_accepted");
}

TEST_CASE_METHOD(two_arms, "A disk that does not answer refuses a task",
                 "[task_changes]") {
  slow_disk = true;
  const auto reply = post(both());
  time.advance(4900ms);
  CHECK_FALSE(*reply);
  time.advance(200ms);
  // What might have been written after all is removed.
  time.advance(5100ms);
  REQUIRE(*reply);
  CHECK(error_of(reply_of(reply)) != "");
  CHECK(running() == 0);
  CHECK(left.deployments.empty());
}

TEST_CASE_METHOD(two_arms, "A termination is answered when it is stored",
                 "[task_changes]") {
  request(both());
  disk_full = true;
  const auto reply = post(termination("t"));
  // A robot with a full disk can be stopped.
  CHECK(running() == 0);
  CHECK_FALSE(*reply);
  time.advance(3s);
  CHECK_FALSE(*reply);
  CHECK(count("task_terminated") == 0);
  disk_full = false;
  time.advance(5s);
  REQUIRE(*reply);
  CHECK(reply_of(reply).at("instances").size() == 2);
  CHECK(disk.empty());
  CHECK(count("task_terminated") == 1);
}

TEST_CASE_METHOD(two_arms,
                 "A termination that is not stored in time says so, and is "
                 "tried until it is",
                 "[task_changes]") {
  request(both());
  disk_full = true;
  const auto reply = post(termination("t"));
  for (int i = 0; i < 40 && !*reply; ++i)
    time.advance(1s);
  REQUIRE(*reply);
  CHECK(has(message_of(reply_of(reply)), "the disk is full"));
  CHECK(error_of(request(both())) == "conflict");
  // Who asks again makes it try at once.
  disk_full = false;
  const auto again = request(termination("t"));
  CHECK(again.at("type") == "task_terminated");
  CHECK(again.at("instances").size() == 2);
  CHECK(disk.empty());
  CHECK(request(both()).at("type") == "task_accepted");
}

namespace {

/// A task whose end is not on disk, and whose nodes have nothing of it left.
struct unwritten_end : two_arms {
  unwritten_end() {
    request(both());
    disk_full = true;
    const auto reply = post(termination("t"));
    for (int i = 0; i < 90 && !*reply; ++i)
      time.advance(1s);
    REQUIRE(*reply);
    REQUIRE(has(message_of(reply_of(reply)), "the disk is full"));
    // However long that lasts.
    time.advance(30min);
    REQUIRE(disk.count("t") == 1);
    disk_full = false;
  }
};

} // namespace

TEST_CASE_METHOD(unwritten_end,
                 "A refused termination is on disk soon after there is room",
                 "[task_changes]") {
  time.advance(2s);
  CHECK(disk.empty());
  CHECK(count("task_terminated") == 1);
}

TEST_CASE_METHOD(unwritten_end,
                 "A refused termination is on disk as soon as anything else is",
                 "[task_changes]") {
  request(echo_task("other", {echo_step("s0", 1, "left")}));
  time.advance(1ms);
  CHECK(disk.count("t") == 0);
  CHECK(disk.count("other") == 1);
  CHECK(count("task_terminated") == 1);
}

TEST_CASE_METHOD(two_arms, "An end that was not stored is stored later",
                 "[task_changes]") {
  request(echo_task("t", {echo_step("s0", 1, "left")}));
  disk_full = true;
  auto row = left.running.begin()->second;
  row.state = instance_state::stopped;
  row.exit_code = 0;
  left.report_row(row);
  time.settle();
  CHECK(count("task_finished") == 0);
  disk_full = false;
  time.advance(1s);
  CHECK(disk.at("t").at("state") == "finished");
  CHECK(count("task_finished") == 1);
}

TEST_CASE_METHOD(two_arms, "Nothing is told before the store has kept it",
                 "[task_changes]") {
  slow_disk = true;
  const auto reply = post(both());
  CHECK(tasks().empty());
  CHECK(left.deployments.empty());
  // The next one does not count on what is being written.
  const auto next = post(echo_task("u", {echo_step("s0", 3, "left")}));
  CHECK_FALSE(*next);
  slow_disk = false;
  finish_writes();
  time.settle();
  CHECK(reply_of(reply).at("type") == "task_accepted");
  CHECK(error_of(reply_of(next)) == "no_feasible_allocation");
}

TEST_CASE_METHOD(two_arms,
                 "A live node that did not remove in time is asked again",
                 "[task_changes]") {
  const auto accepted = request(both());
  right.slow_removals = true;
  const auto reply = post(termination("t"));
  time.advance(limits::task::removal_answer - 1s);
  CHECK_FALSE(*reply);
  CHECK(right.running.size() == 1);
  right.slow_removals = false;
  time.advance(1s);
  REQUIRE(*reply);
  CHECK(reply_of(reply).at("pending_nodes") == json{"right"});
  time.advance(5s);
  CHECK(right.running.empty());
  // By its id: the task's name may be in use again.
  CHECK(right.removals.back().instance
        == accepted.at("instances")[1].at("instance"));
  const auto asked = right.removals.size();
  time.advance(5min);
  CHECK(right.removals.size() == asked);
}

TEST_CASE_METHOD(two_arms,
                 "A node that registers anew is not asked again besides",
                 "[task_changes]") {
  request(both());
  right.slow_removals = true;
  post(termination("t"));
  time.advance(limits::task::removal_answer + 1ms);
  lose(right);
  ++right.identity.epoch;
  right.slow_removals = false;
  const auto asked = right.removals.size();
  const auto verdicts = enter(right)->verdicts;
  REQUIRE(verdicts.size() == 1);
  CHECK(verdicts[0].what == verdict::stop);
  time.advance(5min);
  CHECK(right.removals.size() <= asked + 1);
}

TEST_CASE_METHOD(two_arms,
                 "The same request waits for the first one as long as it takes",
                 "[task_changes]") {
  right.mood = temper::slow;
  const auto first = post(both());
  const auto second = post(both());
  time.advance(10min);
  CHECK_FALSE(*first);
  CHECK_FALSE(*second);
  right.finish_starting();
  time.settle();
  REQUIRE(*second);
  CHECK(reply_of(first).at("type") == "task_accepted");
  CHECK(reply_of(second).at("found") == "running");
  CHECK(placement_in(reply_of(second)) == placement_in(reply_of(first)));
}

TEST_CASE_METHOD(two_arms, "A request that deploys ends with the coordinator",
                 "[task_changes]") {
  right.mood = temper::slow;
  const auto reply = post(both());
  CHECK_FALSE(*reply);
  caf::anon_send_exit(coordinator, caf::exit_reason::user_shutdown);
  time.settle();
  // No time has passed.
  REQUIRE(*reply);
  CHECK(error_of(reply_of(reply)) != "");
  // What the next start finds it drops.
  CHECK(disk.at("t").at("state") == "deploying");
}

} // namespace roscell::test
