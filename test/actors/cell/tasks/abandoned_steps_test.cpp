#include "test/actors/fakes/coordinator_fakes.hpp"

#include "actors/core/limits.hpp"

/// What becomes of steps whose node is lost.
namespace roscell::test {

namespace {

json movable_step(double after_s, int cores = 1) {
  auto result = echo_step("s0", cores);
  result["on_node_loss"] = {{"policy", "move"}, {"after_s", after_s}};
  return result;
}

/// A step on `left` that moves after 30 s.
struct lossy_cell : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  explicit lossy_cell(const json& step = movable_step(30)) {
    base.has.cpu.used = 4;
    right.has.cpu.used = 4;
    REQUIRE(request(echo_task("a", {step})).at("type") == "task_accepted");
    REQUIRE(left.running.size() == 1);
    right.has.cpu.used = 0;
  }

  json row_of_a() {
    return request({{"type", "task_query"}, {"task", "a"}})
        .at("tasks")[0]
        .at("instances")[0];
  }

  std::string node_of_a() {
    return row_of_a().at("node").get<std::string>();
  }

  std::string waits() {
    return row_of_a().value("waits", "");
  }

  /// What is said of the step where it was lost.
  std::string waits_on_left() {
    const auto cell = request({{"type", "cell_query"}});
    for (const auto& node : cell.at("nodes"))
      if (node.at("identity").at("name") == "left")
        return node.at("instances").at(0).value("waits", "");
    return "";
  }
};

} // namespace

TEST_CASE_METHOD(lossy_cell, "A step moves once its node is lost for so long",
                 "[abandoned_steps]") {
  lose(left);
  CHECK(waits() == "moves unless node 'left' is back within 30 s");
  CHECK(waits_on_left() == waits());
  time.advance(29s);
  CHECK(right.running.empty());
  time.advance(2s);
  CHECK(right.running.size() == 1);
  CHECK(node_of_a() == "right");
  CHECK(waits_on_left() == "no longer wanted, ends once node 'left' is back");
  CHECK(disk.at("a").at("nodes") == json{"right"});
  CHECK(count("instance_out_of_reach") == 1);
  CHECK(count("instance_moved") == 1);
  CHECK(count("task_failed") == 0);
}

TEST_CASE_METHOD(lossy_cell, "The time counts from the node's last word",
                 "[abandoned_steps]") {
  caf::anon_send(coordinator,
                 member_lost{left.identity.uuid, left.member, "gone", 8000});
  time.advance(21s);
  CHECK(right.running.empty());
  time.advance(2s);
  CHECK(right.running.size() == 1);
}

TEST_CASE("A step that waits stays with its node, however long",
          "[abandoned_steps]") {
  lossy_cell x{echo_step("s0", 1)};
  x.lose(x.left);
  CHECK(x.waits() == "waits for node 'left'");
  x.time.advance(10min);
  CHECK(x.right.running.empty());
  CHECK(x.node_of_a() == "left");
}

TEST_CASE_METHOD(lossy_cell, "A node that is back in time keeps its step",
                 "[abandoned_steps]") {
  lose(left);
  time.advance(29s);
  const auto reply = enter(left);
  REQUIRE(reply);
  REQUIRE(reply->verdicts.size() == 1);
  CHECK(reply->verdicts[0].what == verdict::keep);
  time.advance(10min);
  CHECK(right.running.empty());
  CHECK(waits() == "");
}

TEST_CASE_METHOD(lossy_cell, "A node that is back too late ends its step",
                 "[abandoned_steps]") {
  lose(left);
  time.advance(31s);
  REQUIRE(right.running.size() == 1);
  const auto reply = enter(left);
  REQUIRE(reply);
  REQUIRE(reply->verdicts.size() == 1);
  CHECK(reply->verdicts[0].what == verdict::stop);
}

TEST_CASE_METHOD(lossy_cell, "A node that is back while its step moves ends it",
                 "[abandoned_steps]") {
  right.mood = temper::slow;
  lose(left);
  time.advance(31s);
  REQUIRE(right.starting.size() == 1);
  const auto reply = enter(left);
  REQUIRE(reply);
  CHECK(reply->verdicts.at(0).what == verdict::stop);
}

TEST_CASE_METHOD(lossy_cell,
                 "A node that is back while the move is written ends its step",
                 "[abandoned_steps]") {
  slow_disk = true;
  lose(left);
  time.advance(31s);
  REQUIRE_FALSE(writes.empty());
  auto reply = time.ask<node_registered>(
      coordinator, register_node{{left.identity,
                                  3,
                                  left.has,
                                  {echo_skill()},
                                  {left.running.begin()->second}},
                                 left.member});
  time.settle();
  slow_disk = false;
  finish_writes();
  time.settle();
  REQUIRE(reply->has_value());
  REQUIRE(reply->value());
  CHECK(reply->value()->verdicts.at(0).what == verdict::stop);
  CHECK(right.running.size() == 1);
}

TEST_CASE("A lost step that fits nowhere waits, and says why",
          "[abandoned_steps]") {
  lossy_cell x{movable_step(30, 2)};
  x.right.has.cpu.used = 3;
  x.lose(x.left);
  x.time.advance(40s);
  CHECK(x.waits().rfind("waits for a place: ", 0) == 0);
  CHECK(x.count("step_stranded") == 1);
  SECTION("it goes where there is room at last") {
    x.right.has.cpu.used = 0;
    x.time.advance(limits::retry::longest + 1s);
    CHECK(x.right.running.size() == 1);
  }
  SECTION("its node comes back, and it goes on there") {
    const auto reply = x.enter(x.left);
    REQUIRE(reply);
    CHECK(reply->verdicts.at(0).what == verdict::keep);
    x.right.has.cpu.used = 0;
    x.time.advance(10min);
    CHECK(x.right.running.empty());
  }
}

TEST_CASE_METHOD(lossy_cell, "A place that comes to nothing is tried again",
                 "[abandoned_steps]") {
  right.mood = temper::slow;
  lose(left);
  time.advance(31s);
  REQUIRE(right.starting.size() == 1);
  auto failed = right.running.begin()->second;
  failed.state = instance_state::failed;
  right.report_row(failed);
  right.fail_starting("no camera");
  time.settle();
  CHECK(count("task_failed") == 0);
  right.mood = temper::happy;
  time.advance(2 * limits::retry::longest);
  CHECK(right.running.size() == 1);
  CHECK(node_of_a() == "right");
}

TEST_CASE_METHOD(lossy_cell,
                 "What does not come up is tried again soon, then less often",
                 "[abandoned_steps]") {
  right.mood = temper::broken;
  lose(left);
  time.advance(31s);
  const auto tried = right.deployments.size();
  REQUIRE(tried >= 1);
  time.advance(2s);
  CHECK(right.deployments.size() > tried);
  time.advance(5min);
  // Once in half a minute at last.
  const auto later = right.deployments.size();
  time.advance(5min);
  CHECK(right.deployments.size() - later >= 10);
  CHECK(right.deployments.size() - later <= 21);
  right.mood = temper::happy;
  time.advance(limits::retry::longest);
  CHECK(right.running.size() == 1);
  CHECK(node_of_a() == "right");
}

TEST_CASE("Where the new place is lost, too, its fence is waited for",
          "[abandoned_steps]") {
  lossy_cell x{movable_step(60)};
  auto& third = x.add("third");
  third.has.cpu.used = 4;
  x.right.mood = temper::slow;
  x.lose(x.left);
  x.time.advance(61s);
  REQUIRE(x.right.starting.size() == 1);
  third.has.cpu.used = 0;
  // A member that is lost fails what it was asked for before it is told of.
  SECTION("at once") {
    x.right.fail_starting("node 'right' is out of reach");
    x.time.settle();
  }
  SECTION("some time after the program did not come up") {
    x.right.fail_starting("no camera");
    x.time.settle();
    x.right.silent = x.right.slow_removals = true;
    x.time.advance(100ms);
  }
  x.lose(x.right);
  x.time.advance(59s);
  CHECK(third.running.empty());
  CHECK(third.deployments.empty());
  x.time.advance(limits::retry::longest);
  CHECK(third.running.size() == 1);
}

TEST_CASE_METHOD(lossy_cell, "A task that is ended meanwhile moves nowhere",
                 "[abandoned_steps]") {
  lose(left);
  request(termination("a"));
  time.advance(10min);
  CHECK(right.running.empty());
}

TEST_CASE_METHOD(lossy_cell,
                 "A lost step starts nowhere before its fence has ended it, "
                 "whoever asks",
                 "[abandoned_steps]") {
  const json release{
      {"type", "node_release"}, {"node", "left"}, {"instances", "reschedule"}};
  lose(left);
  time.advance(10s);
  const auto refused = request(release);
  REQUIRE(refused.at("type") == "error");
  CHECK(refused.at("error").at("code") == "conflict");
  CHECK(refused.at("error").at("hint")
        == "it has ended there in 20 s, and moves by itself then; or say "
           "\"terminate\"");
  CHECK(right.running.empty());
  CHECK(node_of_a() == "left");
  // Nothing has changed: it moves when it is time, and the node may go.
  time.advance(21s);
  CHECK(right.running.size() == 1);
  CHECK(node_of_a() == "right");
  CHECK(request(release).at("type") == "node_released");
}

TEST_CASE_METHOD(lossy_cell,
                 "A task is not begun anew while a lost step of its name may "
                 "run",
                 "[abandoned_steps]") {
  const auto again = echo_task("a", {movable_step(30)});
  lose(left);
  CHECK(request({{"type", "task_termination"}, {"task", "a"}}).at("type")
        == "task_terminated");
  time.advance(20s);
  const auto refused = request(again);
  REQUIRE(refused.at("type") == "error");
  CHECK(refused.at("error").at("code") == "conflict");
  CHECK(refused.at("error").at("hint")
        == "send it again in 10 s, when it has been ended there, or choose "
           "another task id");
  CHECK(right.running.empty());
  time.advance(11s);
  CHECK(request(again).at("type") == "task_accepted");
  CHECK(right.running.size() == 1);
}

TEST_CASE_METHOD(lossy_cell,
                 "What a node comes back with is there until it has ended",
                 "[abandoned_steps]") {
  const auto again = echo_task("a", {movable_step(30)});
  auto row = left.running.begin()->second;
  left.slow_removals = true;
  lose(left);
  request({{"type", "task_termination"}, {"task", "a"}});
  const auto back = enter(left);
  REQUIRE(back);
  REQUIRE(back->verdicts.at(0).what == verdict::stop);
  time.advance(40s);
  const auto refused = request(again);
  REQUIRE(refused.at("type") == "error");
  CHECK(refused.at("error").at("hint")
        == "send it again once it has ended, or choose another task id");
  SECTION("it ends") {
    row.state = instance_state::stopped;
    left.report_row(row);
    time.settle();
  }
  SECTION("its node is lost once more") {
    lose(left);
    time.advance(20s);
    CHECK(request(again).at("error").at("hint")
          == "send it again in 10 s, when it has been ended there, or choose "
             "another task id");
    time.advance(11s);
  }
  CHECK(request(again).at("type") == "task_accepted");
}

/// A step on `left` that its host starts alone.
struct alone_cell : lossy_cell {
  alone_cell() : lossy_cell(alone_step()) {
    // nop
  }

  static json alone_step() {
    auto result = echo_step("s0", 1);
    result["on_boot"] = "start";
    return result;
  }
};

TEST_CASE_METHOD(alone_cell,
                 "What its host may start alone is started nowhere else",
                 "[abandoned_steps]") {
  const json release{
      {"type", "node_release"}, {"node", "left"}, {"instances", "reschedule"}};
  lose(left);
  CHECK(waits() == "waits for node 'left', which may start it alone");
  time.advance(24h);
  CHECK(request(release).at("error").at("code") == "conflict");
  CHECK(right.running.empty());
  CHECK(node_of_a() == "left");
}

TEST_CASE_METHOD(alone_cell,
                 "A task is not begun anew while a host may start it alone",
                 "[abandoned_steps]") {
  auto again = echo_task("a", {alone_step()});
  lose(left);
  request(termination("a"));
  time.advance(24h);
  CHECK(request(again).at("error").at("code") == "conflict");
  CHECK(right.running.empty());
  SECTION("its node is back, and has ended it") {
    const auto row = left.running.begin()->second;
    REQUIRE(enter(left));
    CHECK(count("instance_unwanted") == 1);
    auto ended = row;
    ended.state = instance_state::stopped;
    left.report_row(ended);
    time.settle();
  }
  SECTION("somebody says that the host stays off") {
    again["force"] = true;
  }
  CHECK(request(again).at("type") == "task_accepted");
}

TEST_CASE_METHOD(lossy_cell, "A node that leaves in order is lost, too",
                 "[abandoned_steps]") {
  depart(left);
  time.advance(31s);
  CHECK(right.running.size() == 1);
}

TEST_CASE_METHOD(lossy_cell,
                 "Another machine of that name does not run the step early",
                 "[abandoned_steps]") {
  lose(left);
  time.advance(20s);
  auto& twin = make_agent("left");
  twin.identity.uuid = "uuid-of-another";
  twin.has.cpu.used = 4;
  const auto reply = enter(twin);
  REQUIRE(reply);
  CHECK(reply->verdicts.empty());
  CHECK(twin.running.empty());
  time.advance(11s);
  CHECK(right.running.size() == 1);
}

TEST_CASE("What was given up holds its step over a restart of the coordinator",
          "[abandoned_steps]") {
  lossy_cell before{movable_step(60)};
  before.right.mood = temper::slow;
  before.post({{"type", "node_release"},
               {"node", "left"},
               {"instances", "reschedule"}});
  REQUIRE(before.right.starting.size() == 1);
  // The new one may run on there, and is no longer wanted.
  before.lose(before.right);
  before.right.fail_starting("node 'right' is out of reach");
  before.time.settle();
  REQUIRE(before.node_of_a() == "left");
  const auto record = before.disk.at("a").get<task_record>();
  REQUIRE(record.specs.size() == 1);
  paper_cell after{{record}};
  after.base.has.cpu.used = 4;
  // The host of the old one has been switched off and on meanwhile.
  auto& left = after.add("left");
  after.time.advance(59s);
  CHECK(left.running.empty());
  after.time.advance(limits::retry::longest);
  CHECK(left.running.size() == 1);
}

TEST_CASE("A coordinator that starts again counts from its start",
          "[abandoned_steps]") {
  lossy_cell before;
  const auto record = before.disk.at("a").get<task_record>();
  paper_cell after{{record}};
  auto& right = after.add("right");
  after.base.has.cpu.used = 4;
  // It expects the node that it had.
  auto& left = after.make_agent("left");
  left.running = before.left.running;
  after.time.advance(20s);
  CHECK(right.running.empty());
  const auto reply = after.enter(left);
  REQUIRE(reply);
  CHECK(reply->verdicts.at(0).what == verdict::keep);
}

TEST_CASE("What a record has left on a node that is gone holds no step",
          "[abandoned_steps]") {
  lossy_cell before;
  auto record = before.disk.at("a").get<task_record>();
  record.left = {{"a-s0-old", "s0", "gone", life_policy{}}};
  paper_cell cell{{record}};
  auto& left = cell.make_agent("left");
  left.running = before.left.running;
  REQUIRE(cell.enter(left));
  CHECK(cell.request({{"type", "task_restart"}, {"task", "a"}}).at("type")
        == "task_restarted");
  CHECK(left.running.size() == 1);
  CHECK(left.running.count(record.specs.front().instance) == 0);
}

TEST_CASE("What a task has left on a lost node is known though the coordinator "
          "begins anew",
          "[abandoned_steps]") {
  lossy_cell cell{movable_step(60)};
  cell.lose(cell.left);
  REQUIRE(cell.request(termination("a")).at("type") == "task_terminated");
  CHECK(cell.tasks().empty());
  const auto times = GENERATE(0, 1, 2);
  for (int i = 0; i < times; ++i)
    cell.begin_anew();
  REQUIRE(cell.enter(cell.right));
  const auto again = echo_task("a", {movable_step(60)});
  CHECK(error_of(cell.request(again)) == "conflict");
  CHECK(cell.right.running.empty());
  SECTION("until its fence has passed") {
    cell.time.advance(61s);
    CHECK(cell.disk.empty());
    CHECK(cell.request(again).at("type") == "task_accepted");
  }
  SECTION("until its node is back without it") {
    cell.left.running.clear();
    REQUIRE(cell.enter(cell.left));
    cell.time.advance(1s);
    CHECK(cell.disk.empty());
    CHECK(cell.request(again).at("type") == "task_accepted");
  }
}

} // namespace roscell::test
