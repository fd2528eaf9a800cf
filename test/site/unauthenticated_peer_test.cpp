#include "test/site/watch/site_watch.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

/// What unauthenticated peers announce, copies of data directories, and
/// namesakes: who has proved nothing changes nothing.
namespace roscell::test {

namespace {

struct lone_cell {
  virtual_time clock;
  site place{clock, 1};
  site_party& base = place.add_coordinator("c-0");
  site_party& arm = place.add_node(base.discovery_server);

  void form() {
    place.start(base);
    place.start(arm);
    place.pass(5s);
    REQUIRE(row_of(arm.uuid) == "active");
  }

  /// The state of the row, or "none".
  std::string row_of(const std::string& uuid) {
    const auto* row = base.cell_state().registry.find_uuid(uuid);
    return row ? to_string(row->row.state) : "none";
  }

  size_t count(const site_party& who, const std::string& what) {
    return static_cast<size_t>(std::count_if(
        place.events.begin(), place.events.end(),
        [&](const auto& x) { return x.party == who.index && x.what == what; }));
  }

  void announce(const node_presence& who) {
    caf::anon_send(base.coordinator, presence_seen{who});
    place.pass(1s);
  }
};

node_presence unassigned_node(const site_party& like, int64_t epoch,
                              const std::string& address) {
  node_presence result;
  result.role = "independent";
  result.name = like.name;
  result.uuid = like.uuid;
  result.epoch = epoch;
  result.address = address;
  return result;
}

} // namespace

TEST_CASE_METHOD(lone_cell,
                 "What nobody has proved erases no row of a node "
                 "that is away",
                 "[site][unauthenticated_peer]") {
  form();
  auto& other = place.add_node("wait");
  place.start(other);
  place.kill(arm);
  place.pass(10s);
  REQUIRE(row_of(arm.uuid) == "lost");
  // Nobody is there, or somebody else.
  announce(unassigned_node(arm, 1000, "10.6.6.6:666"));
  announce(unassigned_node(arm, 1001, other.address));
  place.pass(100s);
  CHECK(row_of(arm.uuid) == "lost");
  // A restarted coordinator knows no better.
  place.kill(base);
  place.start(base);
  place.pass(1s);
  REQUIRE(row_of(arm.uuid) == "expected");
  announce(unassigned_node(arm, 1002, other.address));
  place.pass(20s);
  CHECK(row_of(arm.uuid) == "expected");
  place.start(arm);
  place.pass(40s);
  CHECK(row_of(arm.uuid) == "active");
}

TEST_CASE_METHOD(lone_cell,
                 "A node that proves that it is in no cell loses "
                 "its row",
                 "[site][unauthenticated_peer]") {
  form();
  place.split({0, 1});
  place.pass(20s);
  REQUIRE(row_of(arm.uuid) == "lost");
  clock.ask<node_departed>(arm.membership, leave_cell{"an operator says so"});
  place.kill(arm);
  arm.configured = "wait";
  place.start(arm);
  place.pass(1s);
  CHECK(row_of(arm.uuid) == "lost");
  place.heal_all();
  place.pass(40s);
  CHECK(row_of(arm.uuid) == "none");
}

TEST_CASE_METHOD(lone_cell,
                 "A copy of a data directory is refused by name, "
                 "and the node stays a member",
                 "[site][unauthenticated_peer]") {
  form();
  auto& copy = place.add_node(base.discovery_server);
  copy.uuid = arm.uuid;
  copy.disk = arm.disk;
  place.start(copy);
  place.pass(45s);
  CHECK(count(base, "node_joined") == 1);
  CHECK(count(base, "node_lost") == 0);
  CHECK(count(arm, "cell_joined") == 1);
  CHECK(arm.status().state == node_state::member);
  REQUIRE(count(copy, "join_refused") == 1);
  for (const auto& x : place.events)
    if (x.party == copy.index && x.what == "join_refused") {
      CHECK(x.data.at("reason")
            == "this UUID is in use at " + arm.address
                   + ": its data directory is a copy");
      CHECK(x.data.at("hint").get<std::string>().find("--new-identity")
            != std::string::npos);
    }
  // It comes every half minute.
  CHECK(copy.status().config.identity.epoch
        <= arm.status().config.identity.epoch + 3);
  place.kill(arm);
  place.pass(40s);
  CHECK(copy.status().state == node_state::member);
}

TEST_CASE_METHOD(
    lone_cell, "A robot with another address is back before its lease is over",
    "[site][unauthenticated_peer]") {
  form();
  // Nothing of what it had at the first address gets through any more.
  auto& moved = place.add_node(base.discovery_server);
  moved.name = arm.name;
  moved.uuid = arm.uuid;
  moved.disk = arm.disk;
  place.split({0, 1, 0});
  place.start(moved);
  place.pass(5s);
  CHECK(moved.status().state == node_state::member);
  CHECK(count(moved, "join_refused") == 0);
  CHECK(count(base, "node_joined") == 2);
  CHECK(count(base, "node_lost") == 0);
}

TEST_CASE_METHOD(lone_cell,
                 "A robot with a new disk gets in, also after a "
                 "restart of the coordinator",
                 "[site][unauthenticated_peer]") {
  form();
  place.kill(arm);
  place.pass(10s);
  auto& robot = place.add_node(base.discovery_server);
  robot.name = arm.name;
  // Either may come first in the order of UUIDs.
  const auto new_uuid = GENERATE(as<std::string>{}, "0-0", "f-f");
  robot.uuid = new_uuid;
  place.start(robot);
  place.pass(60s);
  REQUIRE(row_of(robot.uuid) == "active");
  CHECK(base.disk["members"].size() == 1);
  CHECK(base.disk["members"].count(robot.uuid) == 1);
  place.kill(base);
  place.pass(1s);
  place.start(base);
  place.pass(40s);
  CHECK(row_of(robot.uuid) == "active");
  CHECK(row_of(arm.uuid) == "none");
}

TEST_CASE_METHOD(lone_cell, "Records of namesakes lock nobody out",
                 "[site][unauthenticated_peer]") {
  form();
  // As an earlier version has left them.
  const auto record = base.disk["members"].at(arm.uuid);
  for (const std::string uuid : {"0-dead", "f-dead"}) {
    auto twin = json::parse(record);
    twin["identity"]["uuid"] = uuid;
    base.disk["members"][uuid] = twin.dump();
  }
  place.kill(base);
  place.start(base);
  place.pass(40s);
  CHECK(row_of(arm.uuid) == "active");
  CHECK(row_of("0-dead") == "none");
  CHECK(row_of("f-dead") == "none");
  CHECK(base.disk["members"].size() == 1);
}

TEST_CASE_METHOD(lone_cell,
                 "A coordinator that cannot write takes known "
                 "members back and no others",
                 "[site][unauthenticated_peer]") {
  form();
  base.disk_full = true;
  place.kill(arm);
  place.start(arm);
  auto& other = place.add_node(base.discovery_server);
  place.start(other);
  place.pass(20s);
  CHECK(row_of(arm.uuid) == "active");
  CHECK(row_of(other.uuid) == "none");
  CHECK(other.status().state != node_state::member);
  base.disk_full = false;
  place.pass(40s);
  CHECK(row_of(other.uuid) == "active");
}

TEST_CASE_METHOD(lone_cell,
                 "Coordinators that do not exist cost few "
                 "connections",
                 "[site][unauthenticated_peer]") {
  form();
  size_t connects = 0;
  place.judge = [&](const site_message& x) {
    connects += std::string_view{x.what} == "connect" ? 1 : 0;
    return frame_fate::passed;
  };
  node_presence who;
  who.role = "coordinator";
  who.name = "trap";
  who.cell = "trap";
  who.address = "10.6.6.6:666";
  who.discovery_server = "10.6.6.6:11811";
  for (int i = 0; i < 3000; ++i) {
    who.uuid = "0-" + std::to_string(i);
    caf::anon_send(base.coordinator, presence_seen{who});
    place.pass(10ms);
    caf::anon_send(base.coordinator, presence_gone{who});
  }
  CHECK(connects < 60);
  CHECK(row_of(arm.uuid) == "active");
  const auto left = clock.ask<cell_list>(base.coordinator, cell_list_query{});
  place.pass(1s);
  CHECK((*left)->value().cells.size() == 1);
}

} // namespace roscell::test
