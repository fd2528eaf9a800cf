#include "actors/cell/limits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

namespace roscell::test {

namespace {

failure why(const caf::expected<node_registered>& x) {
  REQUIRE_FALSE(x);
  return to_failure(x.error());
}

std::string state_of_task(paper_cell& cell, const std::string& task) {
  const auto reply = cell.request({{"type", "task_query"}, {"task", task}});
  REQUIRE(reply.at("type") == "task_description");
  return reply.at("tasks")[0].at("state").get<std::string>();
}

/// An instance, as a node or a record has it.
instance_spec some_spec(const std::string& id, const std::string& task) {
  return echo_instance(id, task, id);
}

task_record some_record(const std::string& task, task_state state,
                        const std::vector<std::string>& nodes) {
  std::vector<instance_spec> specs;
  for (const auto& node : nodes)
    specs.push_back(some_spec(task + "-on-" + node, task));
  return kept_record(specs, nodes, state);
}

std::string verdict_of(const node_registered& reply, const std::string& id) {
  for (const auto& x : reply.verdicts)
    if (x.instance == id)
      return to_string(x.what);
  return "none";
}

/// A task whose writer sends steadily from one node to another.
struct cell_with_stream : paper_cell {
  fake_agent& arm = add("arm");
  fake_agent& belt = add("belt");
  const json accepted = request(
      echo_task("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1, "belt")}));
  instance_row& reader = arm.running.begin()->second;
  instance_row& writer = belt.running.begin()->second;

  cell_with_stream() {
    writer.spec.output = {{"ros2", "/a", "std_msgs/msg/String"}};
    reader.spec.input = writer.spec.output;
    arm.report_row(reader);
    belt.report_row(writer);
    time.settle();
    writer.metrics.streams.resize(1);
    writer.metrics.streams[0].end = "output:0";
    writer.metrics.streams[0].steady_s = 20;
    reader.metrics.streams.resize(1);
    reader.metrics.streams[0].end = "input:0";
  }
};

} // namespace

TEST_CASE_METHOD(paper_cell, "The coordination node has a row of its own",
                 "[cell_coordinator]") {
  const auto cell = request({{"type", "cell_query"}});
  CHECK(cell.at("cell") == "lab");
  CHECK(cell.at("coordinator") == "base");
  CHECK(cell.at("incarnation") == 3);
  REQUIRE(cell.at("nodes").size() == 1);
  CHECK(cell.at("nodes")[0].at("role") == "coordinator");
  CHECK(cell.at("nodes")[0].at("state") == "active");
  const auto list = request({{"type", "cell_list_query"}});
  CHECK(list.at("cells")[0].at("size") == 1);
}

TEST_CASE_METHOD(paper_cell, "A node that registers gets a row",
                 "[cell_coordinator]") {
  auto& arm = make_agent("arm");
  const auto reply = enter(arm);
  REQUIRE(reply);
  CHECK(reply->cell == "lab");
  CHECK(reply->coordinator == "base");
  CHECK(reply->incarnation == 3);
  CHECK(reply->verdicts.empty());
  CHECK(row("arm").state == row_state::active);
  CHECK(row("arm").role == node_role::primary);
  CHECK(count("node_joined") == 1);
  CHECK(request({{"type", "skill_query"}}).at("skills")[0].at("nodes")
        == json{"arm", "base"});
}

TEST_CASE_METHOD(paper_cell, "A name that another UUID has is refused",
                 "[cell_coordinator]") {
  add("arm");
  auto& other = make_agent("arm");
  other.identity.uuid = "another";
  const auto refused = why(enter(other));
  CHECK(refused.code == error_code::conflict);
  CHECK(refused.message.find("uuid-of-arm") != std::string::npos);
  CHECK(refused.hint.find("--name") != std::string::npos);
  CHECK(row("arm").identity.uuid == "uuid-of-arm");
  CHECK(count("node_joined") == 1);
  other.identity.name = "base";
  CHECK(why(enter(other)).code == error_code::conflict);
}

TEST_CASE_METHOD(paper_cell,
                 "A lost node's name is free for others after one lease",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  lose(arm);
  auto& other = make_agent("arm");
  other.identity.uuid = "another";
  time.advance(8000ms);
  CHECK_FALSE(enter(other));
  time.advance(100ms);
  CHECK(enter(other));
  CHECK(row("arm").identity.uuid == "another");
}

TEST_CASE_METHOD(paper_cell,
                 "A copy of the coordination node's data is refused",
                 "[cell_coordinator]") {
  auto& copy = make_agent("copy");
  copy.identity.uuid = base.identity.uuid;
  copy.identity.epoch = 9;
  CHECK(why(enter(copy)).code == error_code::conflict);
  CHECK(row("base").state == row_state::active);
  CHECK(row("base").role == node_role::coordinator);
}

TEST_CASE_METHOD(paper_cell,
                 "A node at another address is a copy if the one at the former "
                 "address answers",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  auto& copy = make_agent("arm");
  copy.identity.epoch = 2;
  copy.identity.address = "10.0.0.99:8420";
  const auto refused = why(enter(copy));
  CHECK(refused.code == error_code::conflict);
  CHECK(refused.message.find("its data directory is a copy")
        != std::string::npos);
  CHECK(row("arm").identity.address == arm.identity.address);
  CHECK(arm.closed.empty());
}

TEST_CASE_METHOD(paper_cell,
                 "Two members at one address are told, and both have a row",
                 "[cell_coordinator]") {
  auto& arm = make_agent("arm");
  arm.identity.address = "10.0.0.98:8420";
  auto& leg = make_agent("leg");
  leg.identity.address = "10.0.0.99:8420";
  REQUIRE(enter(arm));
  REQUIRE(enter(leg));
  CHECK(count("address_shared") == 0);
  auto& taker = make_agent("taker");
  taker.identity.address = arm.identity.address;
  REQUIRE(enter(taker));
  CHECK(count("address_shared") == 1);
  CHECK(row("arm").state == row_state::active);
  CHECK(row("taker").state == row_state::active);
}

TEST_CASE_METHOD(
    paper_cell,
    "A node whose address has changed gets its row back within its "
    "lease if nobody answers at the former one",
    "[cell_coordinator]") {
  auto& old = add("arm");
  old.silent = true;
  auto& moved = make_agent("arm");
  moved.identity.epoch = 2;
  moved.identity.address = "10.0.0.99:8420";
  node_registration registration;
  registration.identity = moved.identity;
  registration.resources.name = "arm";
  const auto entered = time.ask<node_registered>(
      coordinator, register_node{registration, moved.member});
  time.settle();
  CHECK_FALSE(entered->has_value());
  time.advance(1000ms);
  REQUIRE(entered->has_value());
  REQUIRE(entered->value());
  CHECK(row("arm").identity.address == "10.0.0.99:8420");
  CHECK(row("arm").state == row_state::active);
  CHECK(old.closed.size() == 1);
  CHECK(moved.closed.empty());
  CHECK(count("node_lost") == 0);
}

TEST_CASE_METHOD(paper_cell, "A registration of an old epoch is refused",
                 "[cell_coordinator]") {
  auto& arm = make_agent("arm");
  arm.identity.epoch = 5;
  REQUIRE(enter(arm));
  arm.identity.epoch = 4;
  CHECK(why(enter(arm)).code == error_code::conflict);
  CHECK(row("arm").identity.epoch == 5);
}

TEST_CASE_METHOD(paper_cell,
                 "A node that comes back takes its row over from its old self",
                 "[cell_coordinator]") {
  auto& old = add("arm");
  auto& again = make_agent("arm");
  again.identity.epoch = 2;
  REQUIRE(enter(again));
  CHECK(old.closed.size() == 1);
  CHECK(again.closed.empty());
  CHECK(row("arm").identity.epoch == 2);
  CHECK(request({{"type", "cell_query"}}).at("nodes").size() == 2);
  // What its old session still tells is ignored.
  lose(old);
  depart(old);
  time.kill(old.actor);
  CHECK(row("arm").state == row_state::active);
  CHECK(count("node_lost") == 0);
  CHECK(count("node_left") == 0);
}

TEST_CASE_METHOD(paper_cell, "A lost node keeps its row until it is back",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  lose(arm);
  CHECK(row("arm").state == row_state::lost);
  CHECK(row("arm").reason == "gone");
  CHECK(count("node_lost") == 1);
  REQUIRE(enter(arm));
  CHECK(row("arm").state == row_state::active);
  CHECK(row("arm").reason.empty());
}

TEST_CASE_METHOD(paper_cell, "A node whose member fails without a word is lost",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  time.kill(arm.actor);
  CHECK(row("arm").state == row_state::lost);
  CHECK(count("node_lost") == 1);
}

TEST_CASE_METHOD(paper_cell, "A node that leaves without instances is gone",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  depart(arm);
  CHECK(request({{"type", "cell_query"}}).at("nodes").size() == 1);
  CHECK(count("node_left") == 1);
  depart(arm);
  CHECK(count("node_left") == 1);
}

TEST_CASE_METHOD(paper_cell,
                 "A node that leaves before its row is written down has none",
                 "[cell_coordinator]") {
  auto& arm = make_agent("arm");
  node_registration registration;
  registration.identity = arm.identity;
  registration.resources.name = "arm";
  const auto entered = time.ask<node_registered>(
      coordinator, register_node{registration, arm.member});
  depart(arm);
  CHECK(why(entered->value()).code == error_code::conflict);
  CHECK(request({{"type", "cell_query"}}).at("nodes").size() == 1);
  CHECK(count("node_joined") == 0);
  CHECK(count("node_lost") == 0);
}

TEST_CASE_METHOD(paper_cell, "A node that leaves with instances is expected",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  depart(arm);
  CHECK(row("arm").state == row_state::expected);
  CHECK(row("arm").reason == "shut down");
  CHECK(row("arm").instances.size() == 1);
  CHECK(state_of_task(*this, "t") == "degraded");
  const auto back = enter(arm);
  REQUIRE(back);
  CHECK(back->verdicts.size() == 1);
  CHECK(back->verdicts[0].what == verdict::keep);
  CHECK(state_of_task(*this, "t") == "running");
}

TEST_CASE_METHOD(paper_cell,
                 "A task is degraded while an instance of it does not run",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1)}));
  CHECK(state_of_task(*this, "t") == "running");
  auto broken = arm.running.begin()->second;
  broken.state = instance_state::failed;
  broken.exit_code = 3;
  broken.reason = "it exited with code 3";
  arm.report_row(broken);
  time.settle();
  CHECK(state_of_task(*this, "t") == "degraded");
  const auto shown =
      request({{"type", "instance_query"}, {"instance", broken.spec.instance}});
  CHECK(shown.at("instances")[0].at("exit_code") == 3);
  REQUIRE(count("instance_changed") >= 1);
  CHECK(events.back().data.at("reason") == "it exited with code 3");
}

TEST_CASE_METHOD(paper_cell,
                 "Instances are shown with what their nodes say now",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  auto& known = arm.running.begin()->second;
  known.status = "frames=120";
  known.metrics = {120, 2.5, 3, 0.85};
  const auto shown = [&] {
    return request({{"type", "instance_query"}}).at("instances").at(0);
  };
  CHECK(shown().at("status") == "frames=120");
  CHECK(shown().at("figures")
        == json{{"frames", 120},
                {"rate_hz", 2.5},
                {"dropped", 3},
                {"latency_ms", 0.85}});
  SECTION("a node that is silent has no metrics, and holds up nobody") {
    arm.mute = true;
    arm.report_row(known);
    const auto reply = post({{"type", "instance_query"}});
    time.advance(limits::resource::collection);
    const auto row = reply_of(reply).at("instances").at(0);
    CHECK_FALSE(row.contains("figures"));
    CHECK(row.at("state") == "running");
  }
  SECTION("a node that is away has none") {
    arm.report_row(known);
    lose(arm);
    CHECK_FALSE(shown().contains("figures"));
    CHECK(shown().contains("unknown_since_unix_ms"));
  }
  SECTION("what has ended keeps its last ones") {
    known.state = instance_state::stopped;
    arm.report_row(known);
    time.settle();
    CHECK(shown().at("figures").at("frames") == 120);
  }
}

TEST_CASE_METHOD(cell_with_stream,
                 "A reader that gets nothing although its writer sends is "
                 "starved, without a bound",
                 "[cell_coordinator]") {
  reader.metrics.streams[0].quiet_s = 20;
  CHECK(state_of_task(*this, "t") == "running");
  const auto shown =
      request({{"type", "instance_query"}, {"instance", reader.spec.instance}});
  CHECK(shown.at("instances")[0].at("health") == "starved");
  CHECK(
      shown.at("instances")[0]
          .at("health_reason")
          .get<std::string>()
          .find("input '/a' has had no frame at all, though step 's1' on node "
                "'belt' goes on sending")
      == 0);
  CHECK(state_of_task(*this, "t") == "degraded");
  CHECK(count("instance_starved") == 1);
  CHECK(count("instance_recovered") == 0);
  reader.metrics.streams[0].quiet_s = 0;
  request({{"type", "instance_query"}});
  CHECK(state_of_task(*this, "t") == "running");
  CHECK(count("instance_starved") == 1);
  CHECK(count("instance_recovered") == 1);
}

TEST_CASE_METHOD(cell_with_stream,
                 "A node that tells of a silent input has its writer asked",
                 "[cell_coordinator]") {
  reader.metrics.streams[0].quiet_s = 30;
  const auto before = count("instance_changed");
  arm.report_row(reader);
  time.settle();
  CHECK(count("instance_starved") == 1);
  // The words of a skill are no change, the judgement is one.
  CHECK(count("instance_changed") == before + 1);
  reader.metrics.streams[0].quiet_s = 0;
  arm.report_row(reader);
  time.settle();
  CHECK(count("instance_recovered") == 1);
  CHECK(state_of_task(*this, "t") == "running");
}

TEST_CASE_METHOD(cell_with_stream,
                 "A reader is judged together with a writer of another task",
                 "[cell_coordinator]") {
  auto& eye = add("eye");
  request(echo_task("u", {echo_step("camera", 1, "eye")}));
  auto& camera = eye.running.begin()->second;
  camera.spec.output = writer.spec.output;
  camera.metrics = writer.metrics;
  writer.metrics.streams[0].steady_s = -1;
  eye.report_row(camera);
  time.settle();
  reader.metrics.streams[0].quiet_s = 30;
  SECTION("when its node has told that its input is silent") {
    arm.report_row(reader);
    time.settle();
  }
  SECTION("when somebody asks for it") {
    request({{"type", "instance_query"}, {"instance", reader.spec.instance}});
  }
  SECTION("when somebody asks for its task") {
    request({{"type", "instance_query"}, {"task", "t"}});
  }
  CHECK(count("instance_starved") == 1);
  CHECK(state_of_task(*this, "t") == "degraded");
  CHECK(state_of_task(*this, "u") == "running");
  CHECK(events.back()
            .data.at("health_reason")
            .get<std::string>()
            .find("step 'camera' of task 'u' on node 'eye' goes on sending")
        != std::string::npos);
}

TEST_CASE_METHOD(paper_cell, "A task is degraded while a node of it is away",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  lose(arm);
  CHECK(state_of_task(*this, "t") == "degraded");
  ++arm.identity.epoch;
  REQUIRE(enter(arm));
  CHECK(state_of_task(*this, "t") == "running");
}

TEST_CASE_METHOD(paper_cell, "An ended instance that no task wants is dropped",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  auto row_on_arm = row_of(some_spec("x", "gone"), "arm");
  arm.report_row(row_on_arm);
  time.settle();
  CHECK(row("arm").instances.size() == 1);
  row_on_arm.state = instance_state::stopped;
  arm.report_row(row_on_arm);
  time.settle();
  CHECK(row("arm").instances.empty());
  CHECK(arm.removals.empty());
}

TEST_CASE_METHOD(paper_cell,
                 "A node that registers is told what to keep, stop and start",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(
      echo_task("t", {echo_step("s0", 1, "arm"), echo_step("s1", 1, "arm")}));
  REQUIRE(arm.running.size() == 2);
  const auto kept = arm.running.begin()->first;
  const auto missing = arm.running.rbegin()->second.spec;
  arm.running.erase(missing.instance);
  arm.running["stray"] = row_of(some_spec("stray", "nobody's"), "arm");
  const auto reply = enter(arm);
  REQUIRE(reply);
  CHECK(reply->verdicts.size() == 3);
  CHECK(verdict_of(*reply, kept) == "keep");
  CHECK(verdict_of(*reply, "stray") == "stop");
  CHECK(verdict_of(*reply, missing.instance) == "start");
  for (const auto& x : reply->verdicts)
    if (x.what == verdict::start) {
      REQUIRE(x.spec.size() == 1);
      CHECK(x.spec[0] == missing);
    } else {
      CHECK(x.spec.empty());
    }
  // What is to stop is there until the node has ended it.
  const auto rows = row("arm").instances;
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].spec.instance == kept);
  CHECK(rows[1].spec.instance == "stray");
}

TEST_CASE("A restarted coordinator takes its running tasks up again",
          "[cell_coordinator]") {
  paper_cell cell{{some_record("t", task_state::running, {"arm", "leg"}),
                   some_record("half", task_state::deploying, {"arm"}),
                   some_record("ending", task_state::terminating, {"arm"})}};
  CHECK(cell.disk.size() == 1);
  CHECK(state_of_task(cell, "t") == "degraded");
  auto& arm = cell.make_agent("arm");
  arm.running["t-on-arm"] = row_of(some_spec("t-on-arm", "t"), "arm");
  arm.running["half-on-arm"] = row_of(some_spec("half-on-arm", "half"), "arm");
  arm.running["ending-on-arm"] =
      row_of(some_spec("ending-on-arm", "ending"), "arm");
  const auto first = cell.enter(arm);
  REQUIRE(first);
  CHECK(verdict_of(*first, "t-on-arm") == "keep");
  CHECK(verdict_of(*first, "half-on-arm") == "stop");
  CHECK(verdict_of(*first, "ending-on-arm") == "stop");
  auto& leg = cell.make_agent("leg");
  const auto second = cell.enter(leg);
  REQUIRE(second);
  CHECK(verdict_of(*second, "t-on-leg") == "start");
  leg.report_row(row_of(some_spec("t-on-leg", "t"), "leg"));
  cell.time.settle();
  CHECK(state_of_task(cell, "t") == "running");
  CHECK(error_of(cell.request(echo_task("t", {echo_step("s0", 1)})))
        == "task_exists");
  const auto end = cell.request(termination("t"));
  CHECK(end.at("type") == "task_terminated");
  CHECK(end.at("instances") == json{"t-on-arm", "t-on-leg"});
}

TEST_CASE("A restarted coordinator puts its own node in order",
          "[cell_coordinator]") {
  auto missing = some_record("missing", task_state::running, {"base"});
  paper_cell cell{{some_record("t", task_state::running, {"base"}), missing},
                  {row_of(some_spec("t-on-base", "t"), "base"),
                   row_of(some_spec("stray", "nobody's"), "base")}};
  CHECK(state_of_task(cell, "t") == "running");
  CHECK(state_of_task(cell, "missing") == "running");
  CHECK(cell.base.running.count("t-on-base") == 1);
  CHECK(cell.base.running.count("stray") == 0);
  REQUIRE(cell.base.deployments.size() == 1);
  CHECK(cell.base.deployments[0] == missing.specs[0]);
  REQUIRE(cell.base.removals.size() == 1);
  CHECK(cell.base.removals[0].instance == "stray");
}

TEST_CASE_METHOD(paper_cell,
                 "What a task wants on a node that is away is still held",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 3, "arm")}));
  lose(arm);
  arm.running.clear();
  REQUIRE(enter(arm));
  CHECK(error_of(request(echo_task("u", {echo_step("s0", 2, "arm")})))
        == "no_feasible_allocation");
  CHECK(request(echo_task("u", {echo_step("s0", 1, "arm")})).at("type")
        == "task_accepted");
}

TEST_CASE("A task's steps are listed in the order in which its data flow",
          "[cell_coordinator]") {
  auto task = some_record("t", task_state::running, {"arm", "leg"});
  task.specs[1].output = {{"ros2", "/a", "std_msgs/msg/String"}};
  task.specs[0].input = task.specs[1].output;
  paper_cell cell{{task}};
  const auto reply = cell.request({{"type", "task_query"}, {"task", "t"}});
  const auto& steps = reply.at("tasks")[0].at("instances");
  REQUIRE(steps.size() == 2);
  CHECK(steps[0].at("spec").at("step") == "t-on-leg");
  CHECK(steps[1].at("spec").at("step") == "t-on-arm");
}

TEST_CASE_METHOD(paper_cell, "What is unknown is refused by its id",
                 "[cell_coordinator]") {
  auto reply = request({{"type", "task_query"}, {"task", "x"}});
  CHECK(error_of(reply) == "unknown_task");
  CHECK(reply.at("error").at("where") == "/task");
  reply = request({{"type", "instance_query"}, {"instance", "x"}});
  CHECK(error_of(reply) == "unknown_task");
  CHECK(reply.at("error").at("where") == "/instance");
  CHECK(error_of(request({{"type", "log_query"}, {"instance", "x"}}))
        == "unknown_task");
  CHECK(request({{"type", "instance_query"}}).at("instances").empty());
}

TEST_CASE_METHOD(paper_cell, "A log comes from the node that has it",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  const json query{{"type", "log_query"},
                   {"instance", arm.running.begin()->first}};
  CHECK(request(query).at("text") == "hello from arm");
  lose(arm);
  CHECK(error_of(request(query)) == "unreachable");
}

namespace {

kept_log log_kept_by(const std::string& node, const std::string& instance,
                     int64_t ended_unix_ms) {
  kept_log result;
  result.instance = instance;
  result.node = node;
  result.ended_unix_ms = ended_unix_ms;
  return result;
}

} // namespace

TEST_CASE_METHOD(paper_cell,
                 "The log of an instance that is gone comes from the node that "
                 "has kept the newest",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  auto& belt = add("belt");
  arm.logs_kept = {log_kept_by("arm", "t-s-1", 1000)};
  belt.logs_kept = {log_kept_by("belt", "t-s-1", 2000),
                    log_kept_by("belt", "t-s-2", 1500)};
  json query{{"type", "log_query"}, {"instance", "t-s-1"}};
  CHECK(request(query).at("text") == "kept by belt");
  query["node"] = "arm";
  CHECK(request(query).at("text") == "kept by arm");
  query["node"] = "nobody";
  CHECK(error_of(request(query)) == "unreachable");
  query = {{"type", "log_query"}, {"instance", "t-s-3"}};
  CHECK(error_of(request(query)) == "unknown_task");
  // Of one that is there its own log is read, unless the earlier one is wanted.
  request(echo_task("t", {echo_step("s0", 1, "arm")}));
  const auto instance = arm.running.begin()->first;
  belt.logs_kept = {log_kept_by("belt", instance, 3000)};
  query["instance"] = instance;
  CHECK(request(query).at("text") == "hello from arm");
  query["previous"] = true;
  CHECK(request(query).at("text") == "kept by belt");
}

TEST_CASE_METHOD(paper_cell,
                 "Kept logs are told of by their ends, without the nodes that "
                 "do not answer",
                 "[cell_coordinator]") {
  auto& arm = add("arm");
  auto& belt = add("belt");
  auto& lift = add("lift");
  arm.logs_kept = {log_kept_by("arm", "t-s-1", 1000)};
  belt.logs_kept = {log_kept_by("belt", "t-s-2", 2000)};
  lift.mute = true;
  const auto reply = request({{"type", "kept_logs_query"}});
  REQUIRE(reply.at("logs").size() == 2);
  CHECK(reply.at("logs")[0].at("instance") == "t-s-2");
  CHECK(reply.at("logs")[1].at("instance") == "t-s-1");
  CHECK(reply.at("silent") == json{"lift"});
}

} // namespace roscell::test
