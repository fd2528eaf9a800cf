#include "actors/cell/books/peer_book.hpp"

#include "actors/house/limits.hpp"

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
using sighting = peer_book::sighting;

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

cell_standing standing(const std::string& uuid, const std::string& cell,
                       int64_t size) {
  cell_standing result;
  result.uuid = uuid;
  result.place = {cell, "base-of-" + uuid, "10.0.0.3:8420", "10.0.0.3:11811"};
  result.size = size;
  return result;
}

} // namespace

TEST_CASE("Of two coordinators the one with the higher UUID opens the session",
          "[peer_book]") {
  peer_book book{"m"};
  CHECK(book.see(coordinator("a"), time_zero) == sighting::appeared);
  CHECK(book.see(coordinator("z"), time_zero) == sighting::appeared);
  CHECK(book.see(coordinator("m"), time_zero) == sighting::ignored);
  const auto due = book.begin_due(time_zero);
  REQUIRE(due.size() == 1);
  CHECK(due[0].uuid == "a");
  CHECK(book.begin_due(time_zero).empty());
}

TEST_CASE("Strangers get few connections at a time", "[peer_book]") {
  peer_book book{"m"};
  for (int i = 0; i < 50; ++i)
    book.see(coordinator("a" + std::to_string(i)), time_zero);
  const auto due = book.begin_due(time_zero);
  CHECK(due.size() == limits::strangers::peer_calls);
  CHECK(book.begin_due(time_zero + 1h).empty());
  for (const auto& x : due)
    book.attempt_failed(x.uuid, "refused", time_zero);
  CHECK(book.begin_due(time_zero + 999ms).empty());
  CHECK(book.next_due() == time_zero + 1s);
  // Those that have not been tried come first.
  for (const auto& x : book.begin_due(time_zero + 1s))
    CHECK(std::none_of(due.begin(), due.end(),
                       [&](const auto& y) { return x.uuid == y.uuid; }));
}

TEST_CASE("A stranger under ever new UUIDs fills and costs no more",
          "[peer_book]") {
  peer_book book{"m"};
  size_t attempts = 0;
  auto now = time_zero;
  for (int i = 0; i < 10'000; ++i) {
    const auto who = coordinator("a" + std::to_string(i));
    book.see(who, now);
    for (const auto& x : book.begin_due(now)) {
      ++attempts;
      book.attempt_failed(x.uuid, "refused", now);
    }
    book.vanish(who);
    now += 1ms;
  }
  CHECK(book.strangers() == 0);
  CHECK(attempts <= limits::strangers::peer_calls * 10);
}

TEST_CASE("Who fails makes room for newcomers, who has not been tried does not",
          "[peer_book]") {
  peer_book book{"m"};
  for (size_t i = 0; i < limits::strangers::coordinators; ++i)
    book.see(coordinator("a" + std::to_string(i)), time_zero);
  CHECK(book.see(coordinator("b"), time_zero) == sighting::ignored);
  const auto due = book.begin_due(time_zero);
  book.attempt_failed(due[0].uuid, "refused", time_zero);
  CHECK(book.see(coordinator("b"), time_zero) == sighting::appeared);
  CHECK(book.see(coordinator("c"), time_zero) == sighting::ignored);
  CHECK(book.strangers() == limits::strangers::coordinators);
  CHECK(book.see(coordinator(due[0].uuid), time_zero) == sighting::ignored);
}

TEST_CASE("Strangers displace nobody who has proved himself", "[peer_book]") {
  peer_handles handles;
  peer_book book{"m"};
  book.see(coordinator("a"), time_zero);
  REQUIRE(book.begin_due(time_zero).size() == 1);
  CHECK(book.attempt_succeeded("a"));
  book.open("a", handles.first);
  book.close("a", handles.first, "cut off", time_zero);
  for (size_t i = 0; i < 2 * limits::strangers::coordinators; ++i)
    book.see(coordinator("0" + std::to_string(i)), time_zero);
  const auto due = book.begin_due(time_zero + 1s);
  REQUIRE_FALSE(due.empty());
  CHECK(due[0].uuid == "a");
}

TEST_CASE("The first failure for a reason is told", "[peer_book]") {
  peer_book book{"m"};
  book.see(coordinator("a", "yard"), time_zero);
  auto now = time_zero;
  const auto fail = [&](const std::string& reason) {
    now = std::max(now, book.next_due());
    REQUIRE(book.begin_due(now).size() == 1);
    return book.attempt_failed("a", reason, now);
  };
  CHECK(fail("refused") == "yard");
  CHECK_FALSE(fail("refused"));
  CHECK(fail("no answer") == "yard");
  const auto rows = book.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].trouble == "no answer");
}

TEST_CASE("A failure of one who announces himself no more makes no presence",
          "[peer_book]") {
  peer_book book{"m"};
  book.see(coordinator("a"), time_zero);
  REQUIRE(book.begin_due(time_zero).size() == 1);
  CHECK(book.vanish(coordinator("a")));
  CHECK_FALSE(book.attempt_failed("a", "refused", time_zero));
  CHECK(book.rows({}).empty());
  CHECK_FALSE(book.attempt_succeeded("a"));
}

TEST_CASE("A session is tried again at once when the coordinator starts anew",
          "[peer_book]") {
  peer_book book{"m"};
  book.see(coordinator("a"), time_zero);
  auto now = time_zero;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(book.begin_due(now).size() == 1);
    book.attempt_failed("a", "refused", now);
    now = book.next_due();
  }
  CHECK(book.see(coordinator("a"), now - 1s) == sighting::repeated);
  CHECK(book.begin_due(now - 1s).empty());
  CHECK(book.see(coordinator("a", "lab", 2), now - 1s) == sighting::changed);
  CHECK(book.begin_due(now - 1s).size() == 1);
}

TEST_CASE("A newer session replaces the former one", "[peer_book]") {
  peer_handles handles;
  peer_book book{"m"};
  CHECK_FALSE(book.open("a", handles.first));
  CHECK(book.tell(handles.first, standing("a", "yard", 3)));
  CHECK(book.open("a", handles.second) == handles.first);
  CHECK_FALSE(book.find_cell("yard"));
  CHECK_FALSE(book.tell(handles.first, standing("a", "yard", 3)));
  CHECK_FALSE(book.close("a", handles.first, "closed", time_zero));
  CHECK(book.find("a"));
  CHECK(book.close("a", handles.second, "closed", time_zero));
  CHECK_FALSE(book.find("a"));
}

TEST_CASE("What a session has told counts more than what is announced",
          "[peer_book]") {
  peer_handles handles;
  peer_book book{"m"};
  book.see(coordinator("a", "yard"), time_zero);
  book.open("a", handles.first);
  book.tell(handles.first, standing("a", "yard", 3));
  // A stranger claims to be that coordinator, and then says farewell.
  auto lie = coordinator("a", "trap");
  lie.address = "10.6.6.6:666";
  book.see(lie, time_zero);
  auto rows = book.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].cell == "yard");
  CHECK(rows[0].address == "10.0.0.3:8420");
  CHECK(rows[0].size == 3);
  book.vanish(lie);
  CHECK(book.find_cell("yard"));
  CHECK(book.rows({}).size() == 1);
  CHECK(book.begin_due(time_zero + 1h).empty());
}

TEST_CASE("The newest claim tells who has a node", "[peer_book]") {
  peer_handles handles;
  peer_book book{"m"};
  book.open("a", handles.first);
  book.open("b", handles.second);
  auto one = standing("a", "yard", 1);
  one.members = {{"arm", "u1", 4, true}};
  auto two = standing("b", "hall", 1);
  two.members = {{"arm", "u1", 5, true}};
  book.tell(handles.first, one);
  book.tell(handles.second, two);
  REQUIRE(book.find_holder("arm"));
  CHECK(book.find_holder("arm")->standing.place.cell == "hall");
  cell_changed gone;
  gone.gone = {"u1"};
  book.tell(handles.second, gone);
  REQUIRE(book.find_holder("arm"));
  CHECK(book.find_holder("arm")->standing.place.cell == "yard");
}

TEST_CASE("A coordinator that has just appeared is expected to tell its size",
          "[peer_book]") {
  peer_handles handles;
  peer_book book{"c-5"};
  CHECK_FALSE(book.expects_standings(time_zero));
  book.see(coordinator("c-1"), time_zero);
  CHECK(book.expects_standings(time_zero + 1s));
  CHECK_FALSE(book.expects_standings(time_zero + limits::cell::sizes));
  book.open("c-1", handles.first);
  CHECK(book.expects_standings(time_zero + 1s));
  book.tell(handles.first, standing("c-1", "lab", 3));
  CHECK_FALSE(book.expects_standings(time_zero + 1s));
}

TEST_CASE("A coordinator that cannot be reached is not expected to tell",
          "[peer_book]") {
  peer_book book{"c-5"};
  book.see(coordinator("c-1"), time_zero);
  REQUIRE(book.begin_due(time_zero).size() == 1);
  book.attempt_failed("c-1", "nobody answers", time_zero);
  CHECK_FALSE(book.expects_standings(time_zero));
}

TEST_CASE("Two cells of one name are shown with that trouble", "[peer_book]") {
  peer_book book{"m"};
  book.see(coordinator("a", "lab"), time_zero);
  const auto rows = book.rows({"lab", "base", "", "", 1, ""});
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].trouble == "it claims the same name as the cell of 'base'");
}

} // namespace roscell::test
