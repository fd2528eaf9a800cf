#include "actors/core/answer_limits.hpp"
#include "test/actors/fakes/careful_cell.hpp"

/// A restart that cannot be finished, since a node is away or a step is not
/// stop-safe in time: what of it stands.
namespace roscell::test {

namespace {

/// Step "s0" of task "a" is on "left" and is not stop-safe; "s1" is on "right".
struct stuck_restart : careful_cell {
  std::string not_stop_safe;
  std::string other;

  void begin(json step_on_right) {
    REQUIRE(request(echo_task("a", {grasp_step("s0", "left"), step_on_right}))
                .at("type")
            == "task_accepted");
    not_stop_safe = on(left, "s0");
    other = on(right, "s1");
    left.not_stop_safe.insert(not_stop_safe);
    right.slow_removals = true;
    post({{"type", "task_restart"}, {"task", "a"}});
    time.settle();
    REQUIRE(orders_on_disk() == 2);
  }

  size_t orders_on_disk() {
    return disk.at("a").get<task_record>().orders.size();
  }

  std::string state_of_s1() {
    return task_of("a").at("instances")[1].at("state");
  }
};

json movable_on_right() {
  auto result = echo_step("s1", 1, "right");
  result["on_node_loss"] = {{"policy", "move"}, {"after_s", 24}};
  return result;
}

} // namespace

TEST_CASE_METHOD(
    stuck_restart,
    "An order to end is taken back of what its node came back with",
    "[task_restart]") {
  begin(grasp_step("s1", "right"));
  right.fail_removals();
  lose(right);
  REQUIRE(enter(right));
  time.advance(limits::task::eviction + 1s);
  CHECK(state_of_s1() == "running");
  // That of the other one stands: it is still asked to be stop-safe.
  CHECK(orders_on_disk() == 1);
  finish(right, other);
  CHECK(state_of_s1() == "stopped");
  CHECK(task_of("a").at("instances")[1].at("exit_code") == 0);
}

TEST_CASE_METHOD(
    stuck_restart,
    "What its fence has ended while it was to be restarted has not "
    "failed",
    "[task_restart]") {
  begin(movable_on_right());
  right.fail_removals();
  lose(right);
  right.running.clear();
  time.advance(limits::task::eviction + 1s);
  CHECK(state_of_s1() != "failed");
  right.slow_removals = false;
  REQUIRE(enter(right));
  time.advance(1min);
  CHECK(state_of_s1() == "running");
  CHECK(right.running.size() == 1);
}

TEST_CASE_METHOD(careful_cell,
                 "An end is written down though an order beside it is taken "
                 "back",
                 "[task_restart]") {
  request(
      echo_task("a", {echo_step("s0", 1, "left"), echo_step("s1", 1, "left")}));
  const auto ended = on(left, "s0");
  const auto live = on(left, "s1");
  const auto programs = left.running;
  left.slow_removals = true;
  post({{"type", "task_restart"}, {"task", "a"}});
  time.settle();
  begin_anew();
  left.finish_removals();
  left.slow_removals = false;
  REQUIRE(enter(right));
  left.running = programs;
  left.running.at(ended).state = instance_state::stopped;
  left.running.at(ended).exit_code = 0;
  REQUIRE(enter(left));
  time.advance(1min);
  // By order it has failed, so it runs anew; the other one was not told to end.
  CHECK(left.running.count(live) == 1);
  CHECK(task_of("a").at("state") == "running");
  const auto record = disk.at("a").get<task_record>();
  CHECK(record.orders.empty());
  CHECK(disk.at("a").dump().find(ended) == std::string::npos);
}

TEST_CASE("What runs though its task knows that it has ended is ended",
          "[task_restart]") {
  careful_cell before;
  before.right.has.cpu.used = 4;
  REQUIRE(before.request(echo_task("a", {echo_step("s0", 1)})).at("type")
          == "task_accepted");
  auto record = before.disk.at("a").get<task_record>();
  const auto instance = record.specs.front().instance;
  record.ends = {{instance, instance_state::failed, -1, "it was ended", 1}};
  record.state = task_state::failed;
  paper_cell after{{record}};
  auto& left = after.make_agent("left");
  left.running = before.left.running;
  left.running.at(instance).state =
      GENERATE(instance_state::running, instance_state::backing_off,
               instance_state::stopped);
  const bool is_live =
      left.running.at(instance).state != instance_state::stopped;
  const auto reported = after.enter(left);
  REQUIRE(reported);
  CHECK((reported->verdicts.at(0).what == verdict::stop) == is_live);
}

} // namespace roscell::test
