#include "actors/cell/limits.hpp"
#include "actors/cell/tables/peer_table.hpp"

#include <caf/actor_cast.hpp>
#include <caf/actor_system.hpp>
#include <caf/actor_system_config.hpp>
#include <caf/event_based_actor.hpp>
#include <caf/scoped_actor.hpp>

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;
using sighting = peer_table::sighting;

/// Stands for sessions, which are only compared here.
struct peer_handles {
  caf::actor_system_config config;
  caf::actor_system system{config};
  caf::scoped_actor one{system};
  caf::scoped_actor two{system};
  peer_actor first =
      caf::actor_cast<peer_actor>(caf::actor_cast<caf::actor>(one));
  peer_actor second =
      caf::actor_cast<peer_actor>(caf::actor_cast<caf::actor>(two));
};

node_presence coordinator(const std::string& uuid,
                          const std::string& cell = "lab",
                          int64_t incarnation = 1) {
  node_presence result;
  result.role = "coordinator";
  result.name = "base-of-" + uuid;
  result.uuid = uuid;
  result.cell = cell;
  result.incarnation = incarnation;
  result.address = "10.0.0.2:8420";
  result.discovery_server = "10.0.0.2:11811";
  return result;
}

cell_standing status(const std::string& uuid, const std::string& cell,
                     int64_t size) {
  cell_standing result;
  result.uuid = uuid;
  result.place = {cell, "base-of-" + uuid, "10.0.0.3:8420", "10.0.0.3:11811"};
  result.size = size;
  return result;
}

} // namespace

TEST_CASE("Of two coordinators the one with the higher UUID opens the session",
          "[peer_table]") {
  peer_table table{"m"};
  CHECK(table.see(coordinator("a"), time_zero) == sighting::appeared);
  CHECK(table.see(coordinator("z"), time_zero) == sighting::appeared);
  CHECK(table.see(coordinator("m"), time_zero) == sighting::ignored);
  const auto due = table.begin_due(time_zero);
  REQUIRE(due.size() == 1);
  CHECK(due[0].uuid == "a");
  CHECK(table.begin_due(time_zero).empty());
}

TEST_CASE("Unauthenticated peers get few connections at a time",
          "[peer_table]") {
  peer_table table{"m"};
  for (int i = 0; i < 50; ++i)
    table.see(coordinator("a" + std::to_string(i)), time_zero);
  const auto due = table.begin_due(time_zero);
  CHECK(due.size() == limits::unauthenticated_peers::peer_calls);
  CHECK(table.begin_due(time_zero + 1h).empty());
  for (const auto& x : due)
    table.attempt_failed(x.uuid, "refused", time_zero);
  CHECK(table.begin_due(time_zero + 999ms).empty());
  CHECK(table.next_due() == time_zero + 1s);
  // Those that have not been tried come first.
  for (const auto& x : table.begin_due(time_zero + 1s))
    CHECK(std::none_of(due.begin(), due.end(),
                       [&](const auto& y) { return x.uuid == y.uuid; }));
}

TEST_CASE(
    "An unauthenticated peer under ever new UUIDs fills and costs no more",
    "[peer_table]") {
  peer_table table{"m"};
  size_t attempts = 0;
  auto now = time_zero;
  for (int i = 0; i < 10'000; ++i) {
    const auto who = coordinator("a" + std::to_string(i));
    table.see(who, now);
    for (const auto& x : table.begin_due(now)) {
      ++attempts;
      table.attempt_failed(x.uuid, "refused", now);
    }
    table.vanish(who);
    now += 1ms;
  }
  CHECK(table.unauthenticated_peers() == 0);
  CHECK(attempts <= limits::unauthenticated_peers::peer_calls * 10);
}

TEST_CASE("Who fails makes room for newcomers, who has not been tried does not",
          "[peer_table]") {
  peer_table table{"m"};
  for (size_t i = 0; i < limits::unauthenticated_peers::coordinators; ++i)
    table.see(coordinator("a" + std::to_string(i)), time_zero);
  CHECK(table.see(coordinator("b"), time_zero) == sighting::ignored);
  const auto due = table.begin_due(time_zero);
  table.attempt_failed(due[0].uuid, "refused", time_zero);
  CHECK(table.see(coordinator("b"), time_zero) == sighting::appeared);
  CHECK(table.see(coordinator("c"), time_zero) == sighting::ignored);
  CHECK(table.unauthenticated_peers()
        == limits::unauthenticated_peers::coordinators);
  CHECK(table.see(coordinator(due[0].uuid), time_zero) == sighting::ignored);
}

TEST_CASE("Unauthenticated peers displace nobody who has proved himself",
          "[peer_table]") {
  peer_handles handles;
  peer_table table{"m"};
  table.see(coordinator("a"), time_zero);
  REQUIRE(table.begin_due(time_zero).size() == 1);
  CHECK(table.attempt_succeeded("a"));
  table.open("a", handles.first);
  table.close("a", handles.first, "cut off", time_zero);
  for (size_t i = 0; i < 2 * limits::unauthenticated_peers::coordinators; ++i)
    table.see(coordinator("0" + std::to_string(i)), time_zero);
  const auto due = table.begin_due(time_zero + 1s);
  REQUIRE_FALSE(due.empty());
  CHECK(due[0].uuid == "a");
}

TEST_CASE("The first failure for a reason is told", "[peer_table]") {
  peer_table table{"m"};
  table.see(coordinator("a", "yard"), time_zero);
  auto now = time_zero;
  const auto fail = [&](const std::string& reason) {
    now = std::max(now, table.next_due());
    REQUIRE(table.begin_due(now).size() == 1);
    return table.attempt_failed("a", reason, now);
  };
  CHECK(fail("refused") == "yard");
  CHECK_FALSE(fail("refused"));
  CHECK(fail("no answer") == "yard");
  const auto rows = table.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].problem == "no answer");
}

TEST_CASE("A failure of one who announces himself no more makes no presence",
          "[peer_table]") {
  peer_table table{"m"};
  table.see(coordinator("a"), time_zero);
  REQUIRE(table.begin_due(time_zero).size() == 1);
  CHECK(table.vanish(coordinator("a")));
  CHECK_FALSE(table.attempt_failed("a", "refused", time_zero));
  CHECK(table.rows({}).empty());
  CHECK_FALSE(table.attempt_succeeded("a"));
}

TEST_CASE("A session is tried again at once when the coordinator starts anew",
          "[peer_table]") {
  peer_table table{"m"};
  table.see(coordinator("a"), time_zero);
  auto now = time_zero;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(table.begin_due(now).size() == 1);
    table.attempt_failed("a", "refused", now);
    now = table.next_due();
  }
  CHECK(table.see(coordinator("a"), now - 1s) == sighting::repeated);
  CHECK(table.begin_due(now - 1s).empty());
  CHECK(table.see(coordinator("a", "lab", 2), now - 1s) == sighting::changed);
  CHECK(table.begin_due(now - 1s).size() == 1);
}

TEST_CASE("A newer session replaces the former one", "[peer_table]") {
  peer_handles handles;
  peer_table table{"m"};
  CHECK_FALSE(table.open("a", handles.first));
  CHECK(table.note_status(handles.first, status("a", "yard", 3)));
  CHECK(table.open("a", handles.second) == handles.first);
  CHECK_FALSE(table.find_cell("yard"));
  CHECK_FALSE(table.note_status(handles.first, status("a", "yard", 3)));
  CHECK_FALSE(table.close("a", handles.first, "closed", time_zero));
  CHECK(table.find("a"));
  CHECK(table.close("a", handles.second, "closed", time_zero));
  CHECK_FALSE(table.find("a"));
}

TEST_CASE("What a session has told counts more than what is announced",
          "[peer_table]") {
  peer_handles handles;
  peer_table table{"m"};
  table.see(coordinator("a", "yard"), time_zero);
  table.open("a", handles.first);
  table.note_status(handles.first, status("a", "yard", 3));
  // An unauthenticated peer claims to be that coordinator, and then says
  // farewell.
  auto lie = coordinator("a", "trap");
  lie.address = "10.6.6.6:666";
  table.see(lie, time_zero);
  auto rows = table.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].cell == "yard");
  CHECK(rows[0].address == "10.0.0.3:8420");
  CHECK(rows[0].size == 3);
  table.vanish(lie);
  CHECK(table.find_cell("yard"));
  CHECK(table.rows({}).size() == 1);
  CHECK(table.begin_due(time_zero + 1h).empty());
}

TEST_CASE("The newest claim tells who has a node", "[peer_table]") {
  peer_handles handles;
  peer_table table{"m"};
  table.open("a", handles.first);
  table.open("b", handles.second);
  auto one = status("a", "yard", 1);
  one.members = {{"arm", "u1", 4, true}};
  auto two = status("b", "hall", 1);
  two.members = {{"arm", "u1", 5, true}};
  table.note_status(handles.first, one);
  table.note_status(handles.second, two);
  REQUIRE(table.find_holder("arm"));
  CHECK(table.find_holder("arm")->status.place.cell == "hall");
  cell_changed gone;
  gone.gone = {"u1"};
  table.note_status(handles.second, gone);
  REQUIRE(table.find_holder("arm"));
  CHECK(table.find_holder("arm")->status.place.cell == "yard");
}

TEST_CASE("A coordinator that has just appeared is expected to tell its size",
          "[peer_table]") {
  peer_handles handles;
  peer_table table{"c-5"};
  CHECK_FALSE(table.expects_statuses(time_zero));
  table.see(coordinator("c-1"), time_zero);
  CHECK(table.expects_statuses(time_zero + 1s));
  CHECK_FALSE(table.expects_statuses(time_zero + limits::cell::sizes));
  table.open("c-1", handles.first);
  CHECK(table.expects_statuses(time_zero + 1s));
  table.note_status(handles.first, status("c-1", "lab", 3));
  CHECK_FALSE(table.expects_statuses(time_zero + 1s));
}

TEST_CASE("A coordinator that cannot be reached is not expected to tell",
          "[peer_table]") {
  peer_table table{"c-5"};
  table.see(coordinator("c-1"), time_zero);
  REQUIRE(table.begin_due(time_zero).size() == 1);
  table.attempt_failed("c-1", "nobody answers", time_zero);
  CHECK_FALSE(table.expects_statuses(time_zero));
}

TEST_CASE("Two cells of one name are shown with that problem", "[peer_table]") {
  peer_table table{"m"};
  table.see(coordinator("a", "lab"), time_zero);
  const auto rows = table.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].problem == "it claims the same name as the cell of 'base'");
}

} // namespace roscell::test
