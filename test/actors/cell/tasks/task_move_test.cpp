#include "test/actors/fakes/crowded_cell.hpp"

/// What runs on a node that leaves goes on elsewhere.
namespace roscell::test {

namespace {

struct moving_cell : crowded_cell {
  json release() {
    return {{"type", "node_release"},
            {"node", "left"},
            {"instances", "reschedule"}};
  }
};

} // namespace

TEST_CASE_METHOD(moving_cell, "What a leaving node runs goes on elsewhere",
                 "[task_move]") {
  const auto reply = request(release());
  REQUIRE(reply.at("type") == "node_released");
  CHECK(left.running.empty());
  CHECK(right.running.size() == 2);
  CHECK(node_of("a") == "right");
  CHECK(disk.at("a").at("nodes") == json{"right"});
  CHECK(disk.at("a").count("tentative") == 0);
  CHECK(count("instance_moved") == 2);
  // The first reply says where it is now.
  const auto again = request(echo_task("a", {echo_step("s0", 1)}));
  CHECK(again.at("instances")[0].at("node") == "right");
  CHECK(again.at("allocations")[0].at("node") == "right");
}

TEST_CASE_METHOD(moving_cell, "A move has room kept where it goes",
                 "[task_move]") {
  request(release());
  size_t kept = 0;
  for (const auto& asked : right.reservations)
    kept += asked.specs.size();
  CHECK(kept == 2);
}

TEST_CASE_METHOD(moving_cell, "A move for which a node has no room is undone",
                 "[task_move]") {
  right.reluctance = 1;
  const auto reply = request(release());
  CHECK(error_of(reply) == "no_feasible_allocation");
  CHECK(left.running.size() == 2);
  CHECK(right.running.empty());
  CHECK(node_of("a") == "left");
  CHECK(node_of("b") == "left");
  CHECK(disk.at("a").at("nodes") == json{"left"});
  CHECK(row("left").state == row_state::active);
}

TEST_CASE_METHOD(moving_cell, "A move that cannot be stored is undone",
                 "[task_move]") {
  disk_full = true;
  const auto reply = request(release());
  CHECK(error_of(reply) != "");
  CHECK(left.running.size() == 2);
  CHECK(right.running.empty());
  CHECK(right.deployments.empty());
  CHECK(node_of("a") == "left");
}

TEST_CASE_METHOD(moving_cell,
                 "A move whose instance does not come up is undone",
                 "[task_move]") {
  right.mood = temper::broken;
  CHECK(error_of(request(release())) == "engine_failed");
  CHECK(left.running.size() == 2);
  CHECK(right.running.empty());
  CHECK(node_of("b") == "left");
  CHECK(disk.at("b").at("nodes") == json{"left"});
}

TEST_CASE_METHOD(moving_cell,
                 "A move whose node falls silent on the way is undone",
                 "[task_move]") {
  right.mood = temper::slow;
  const auto reply = post(release());
  REQUIRE(right.starting.size() == 2);
  lose(left);
  right.finish_starting();
  time.settle();
  CHECK(error_of(reply_of(reply)) == "unreachable");
  CHECK(right.running.empty());
  CHECK(node_of("a") == "left");
  CHECK(disk.at("b").at("nodes") == json{"left"});
  CHECK(count("instance_moved") == 0);
  CHECK(count("node_lost") == 1);
  CHECK(count("instance_out_of_reach") == 2);
  // What it ran on with is still wanted there.
  const auto back = enter(left);
  REQUIRE(back);
  REQUIRE(back->verdicts.size() == 2);
  CHECK(back->verdicts[0].what == verdict::keep);
}

TEST_CASE_METHOD(moving_cell,
                 "What a node runs that is lost goes elsewhere on one's word",
                 "[task_move]") {
  lose(left);
  CHECK(request(release()).at("type") == "node_released");
  CHECK(right.running.size() == 2);
}

TEST_CASE_METHOD(moving_cell, "A task waits until a move holds its room",
                 "[task_move]") {
  right.slow_reports = true;
  const auto reply = post(release());
  const auto next = post(echo_task("c", {echo_step("s0", 4, "right")}));
  CHECK_FALSE(*next);
  CHECK(right.reports.size() == 1);
  right.slow_reports = false;
  right.finish_reports();
  time.settle();
  CHECK(reply_of(reply).at("type") == "node_released");
  CHECK(error_of(reply_of(next)) == "no_feasible_allocation");
}

TEST_CASE("A task that is terminated while it moves leaves nothing",
          "[task_move]") {
  for (size_t handled = 0; handled < 90; ++handled) {
    CAPTURE(handled);
    moving_cell cell;
    const auto moved = cell.time.ask<request_routed>(
        cell.router, route_request{cell.release().dump()});
    for (size_t i = 0; i < handled && cell.time.scheduler.has_job(); ++i)
      cell.time.scheduler.run_once();
    const auto ended =
        cell.time.ask<task_terminated>(cell.coordinator, task_termination{"a"});
    cell.time.settle();
    REQUIRE(*ended);
    REQUIRE(*ended->operator->());
    REQUIRE(*moved);
    CHECK(reply_of(moved).at("type") == "node_released");
    CHECK(cell.tasks().size() == 1);
    CHECK(cell.disk.size() == 1);
    CHECK(cell.left.running.empty());
    REQUIRE(cell.right.running.size() == 1);
    CHECK(cell.right.running.begin()->second.spec.task == "b");
    CHECK(cell.request({{"type", "instance_query"}}).at("instances").size()
          == 1);
  }
}

TEST_CASE("A restarted coordinator drops a move that went on", "[task_move]") {
  const auto added = echo_instance("t-new");
  auto record = kept_record({echo_instance("t-old"), added}, {"left", "right"});
  record.tentative = {"t-new"};
  paper_cell cell{{record}};
  auto& right = cell.make_agent("right");
  right.running["t-new"] = row_of(added, "right");
  const auto reply = cell.enter(right);
  REQUIRE(reply);
  REQUIRE(reply->verdicts.size() == 1);
  CHECK(reply->verdicts[0].what == verdict::stop);
}

} // namespace roscell::test
