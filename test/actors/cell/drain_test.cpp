#include "test/actors/fakes/crowded_cell.hpp"

#include "actors/core/limits.hpp"
#include "test/words.hpp"

/// Nodes that are to be empty.
namespace roscell::test {

namespace {

json drain(const std::string& node) {
  return {{"type", "node_drain"}, {"node", node}};
}

json undrain(const std::string& node) {
  return {{"type", "node_undrain"}, {"node", node}};
}

} // namespace

TEST_CASE_METHOD(crowded_cell,
                 "A drained node is emptied and takes nothing new", "[drain]") {
  const auto reply = request(drain("left"));
  REQUIRE(reply.at("type") == "node_drained");
  CHECK(reply.at("left").size() == 2);
  time.settle();
  CHECK(left.running.empty());
  CHECK(right.running.size() == 2);
  CHECK(count("node_drained") == 1);
  CHECK(row("left").draining_since_unix_ms > 0);
  CHECK(request(drain("left")).at("left").empty());
  CHECK(error_of(request(echo_task("c", {echo_step("s0", 1, "left")})))
        == "no_feasible_allocation");
  CHECK(drains.size() == 1);
}

TEST_CASE_METHOD(crowded_cell, "An undrained node takes instances again",
                 "[drain]") {
  request(drain("left"));
  CHECK(request({{"type", "node_undrain"}, {"node", "left"}}).at("type")
        == "node_undrained");
  CHECK(drains.empty());
  CHECK(request(echo_task("c", {echo_step("s0", 1, "left")})).at("type")
        == "task_accepted");
  CHECK(row("left").draining_since_unix_ms == 0);
}

TEST_CASE_METHOD(crowded_cell,
                 "What has no place stays until there is one, and it is told",
                 "[drain]") {
  right.has.cpu.used = 4;
  request(drain("left"));
  time.settle();
  CHECK(left.running.size() == 2);
  CHECK(count("node_drain_stuck") == 1);
  CHECK_FALSE(request(drain("left")).value("trouble", "").empty());
  time.advance(5min);
  CHECK(count("node_drain_stuck") == 1);
  right.has.cpu.used = 0;
  time.advance(limits::retry::longest + 1s);
  CHECK(left.running.empty());
  CHECK(count("node_drained") == 1);
}

TEST_CASE_METHOD(crowded_cell,
                 "What runs on a node that is lost while its deployments are "
                 "waited for is not started elsewhere",
                 "[drain]") {
  right.has.cpu.used = 4;
  left.mood = temper::slow;
  post(echo_task("c", {echo_step("s0", 1)}));
  REQUIRE(left.starting.size() == 1);
  right.has.cpu.used = 0;
  request(drain("left"));
  left.fail_starting("the node is out of reach");
  lose(left);
  time.advance(5min);
  CHECK(right.running.empty());
}

namespace {

/// A drained node is away for a while, and comes back.
struct absent_node : crowded_cell {
  void check_that_it_waits() {
    time.advance(5min);
    CHECK(right.running.empty());
    REQUIRE(enter(left));
    time.advance(limits::retry::longest + 1s);
    CHECK(left.running.empty());
    CHECK(right.running.size() == 2);
  }
};

} // namespace

TEST_CASE_METHOD(absent_node,
                 "What a node runs that is away is not started elsewhere",
                 "[drain]") {
  lose(left);
  request(drain("left"));
  check_that_it_waits();
}

TEST_CASE_METHOD(absent_node,
                 "A node that falls silent while it is drained keeps its work",
                 "[drain]") {
  right.mood = temper::slow;
  request(drain("left"));
  REQUIRE(right.starting.size() == 2);
  lose(left);
  right.mood = temper::happy;
  right.finish_starting();
  check_that_it_waits();
}

TEST_CASE_METHOD(crowded_cell,
                 "A node is drained when what it waits for is stop-safe",
                 "[drain]") {
  const auto instance = left.running.begin()->first;
  left.not_stop_safe.insert(instance);
  request(drain("left"));
  time.advance(60s);
  CHECK(count("node_drained") == 0);
  SECTION("by itself") {
    left.become_stop_safe(instance);
  }
  SECTION("by force") {
    auto asked = drain("left");
    asked["force"] = true;
    request(asked);
  }
  time.advance(limits::retry::longest + 1s);
  CHECK(left.running.empty());
  CHECK(count("node_drained") == 1);
}

TEST_CASE_METHOD(crowded_cell, "A node that is not there cannot be drained",
                 "[drain]") {
  CHECK(error_of(request(drain("nobody"))) == "unknown_node");
}

TEST_CASE_METHOD(crowded_cell,
                 "The drain of a node that is gone can be taken away by its "
                 "name",
                 "[drain]") {
  auto& gone = add("gone");
  request(drain("gone"));
  time.settle();
  depart(gone);
  REQUIRE(row("gone").identity.name.empty());
  CHECK(drains.size() == 1);
  const auto unknown = request(undrain("nobody"));
  CHECK(error_of(unknown) == "unknown_node");
  CHECK(has(unknown.at("error").at("hint").get<std::string>(),
            "gone and drained still: gone"));
  CHECK(request(undrain("gone")).at("type") == "node_undrained");
  CHECK(drains.empty());
  REQUIRE(enter(gone));
  CHECK(row("gone").draining_since_unix_ms == 0);
  CHECK(error_of(request(undrain("nobody"))) == "unknown_node");
}

TEST_CASE_METHOD(crowded_cell, "A drained node comes back drained", "[drain]") {
  auto& gone = add("gone");
  request(drain("gone"));
  time.settle();
  depart(gone);
  REQUIRE(enter(gone));
  CHECK(row("gone").draining_since_unix_ms > 0);
}

TEST_CASE_METHOD(crowded_cell, "A node is drained under its present name",
                 "[drain]") {
  right.has.cpu.used = 4;
  request(drain("left"));
  time.settle();
  lose(left);
  left.identity.name = "west";
  left.has.name = "west";
  ++left.identity.epoch;
  REQUIRE(enter(left));
  CHECK(request(drain("west")).at("left").size() == 2);
  CHECK(request(undrain("west")).at("type") == "node_undrained");
  CHECK(drains.empty());
}

TEST_CASE_METHOD(paper_cell,
                 "Of drained nodes that are gone the first ones are forgotten "
                 "when there are too many",
                 "[drain]") {
  auto& first = add("first");
  request(drain("first"));
  depart(first);
  for (size_t i = 1; i < limits::cell::drains; ++i) {
    const auto name = "n" + std::to_string(i);
    auto& x = add(name);
    time.advance(1ms);
    request(drain(name));
    depart(x);
  }
  CHECK(drains.size() == limits::cell::drains);
  CHECK(count("node_undrained") == 0);
  add("last");
  CHECK(request(drain("last")).at("type") == "node_drained");
  CHECK(drains.size() == limits::cell::drains);
  CHECK(drains.count(first.identity.uuid) == 0);
  CHECK(count("node_undrained") == 1);
}

} // namespace roscell::test
