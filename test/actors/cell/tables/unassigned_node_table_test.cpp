#include "actors/cell/limits.hpp"
#include "actors/cell/tables/unassigned_node_table.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

node_presence seen_node(const std::string& name, const std::string& uuid,
                        int64_t epoch = 1,
                        const std::string& role = "independent") {
  node_presence result;
  result.role = role;
  result.name = name;
  result.uuid = uuid;
  result.epoch = epoch;
  result.address = "10.0.0.7:8420";
  return result;
}

bool always(const node_presence&) {
  return true;
}

} // namespace

TEST_CASE("An unassigned node is told as it announced itself last",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  CHECK(table.see(seen_node("arm", "u1"), time_zero)
        == unassigned_node_table::sighting::appeared);
  CHECK(table.see(seen_node("arm", "u1"), time_zero)
        == unassigned_node_table::sighting::repeated);
  CHECK(table.see(seen_node("arm", "u1", 2, "orphaned"), time_zero)
        == unassigned_node_table::sighting::changed);
  const auto rows = table.rows();
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].name == "arm");
  CHECK(rows[0].state == node_state::orphaned);
}

TEST_CASE("A farewell of an earlier life drops nobody",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1", 2), time_zero);
  CHECK_FALSE(table.vanish(seen_node("arm", "u1", 1), 7000));
  CHECK_FALSE(table.vanish(seen_node("arm", "u1", 2, "orphaned"), 7000));
  CHECK_FALSE(table.vanish(seen_node("leg", "u2", 2), 7000));
  CHECK(table.find("u1"));
  CHECK(table.vanish(seen_node("arm", "u1", 2), 7000));
  CHECK_FALSE(table.find("u1"));
}

TEST_CASE("A node that has fallen silent says since when, until it is back",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1"), time_zero);
  CHECK(table.rows()[0].silent_since_unix_ms == 0);
  CHECK(table.vanish(seen_node("arm", "u1"), 5000));
  REQUIRE(table.rows().size() == 1);
  CHECK(table.rows()[0].name == "arm");
  CHECK(table.rows()[0].silent_since_unix_ms == 5000);
  CHECK(table.size() == 0);
  SECTION("it announces itself") {
    table.see(seen_node("arm", "u1"), time_zero);
    REQUIRE(table.rows().size() == 1);
    CHECK(table.rows()[0].silent_since_unix_ms == 0);
  }
  SECTION("it registers here") {
    table.registered({"arm", "u1", 1, ""});
    CHECK(table.rows().empty());
  }
}

TEST_CASE("Of the silent nodes the last ones are remembered",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  for (size_t i = 0; i <= limits::unauthenticated_peers::silent_nodes; ++i) {
    const auto node = seen_node("n", "u" + std::to_string(i));
    table.see(node, time_zero);
    table.vanish(node, static_cast<int64_t>(i) + 1);
  }
  const auto rows = table.rows();
  CHECK(rows.size() == limits::unauthenticated_peers::silent_nodes);
  CHECK(std::none_of(rows.begin(), rows.end(),
                     [](const auto& x) { return x.uuid == "u0"; }));
}

TEST_CASE("Looking for a node that announced nothing makes none",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  CHECK_FALSE(table.find("u1"));
  table.forget("u1");
  table.question_failed("u1", "silent", time_zero);
  CHECK(table.rows().empty());
  table.registered({"arm", "u1", 1, ""});
  CHECK(table.rows().empty());
}

TEST_CASE("Of two nodes with one name the newer epoch counts",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1", 5), time_zero);
  table.see(seen_node("arm", "u2", 3), time_zero);
  REQUIRE(table.find_name("arm"));
  CHECK(table.find_name("arm")->uuid == "u1");
  CHECK_FALSE(table.find_name("leg"));
}

TEST_CASE("A registration ends what was announced before it",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1", 5), time_zero);
  table.registered({"arm", "u1", 5, ""});
  CHECK(table.find("u1"));
  table.registered({"arm", "u1", 6, ""});
  CHECK_FALSE(table.find("u1"));
}

TEST_CASE("Unauthenticated peers fill no more than a bound",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  for (size_t i = 0; i < limits::unauthenticated_peers::unassigned_nodes; ++i)
    table.see(seen_node("n", "u" + std::to_string(i)), time_zero);
  CHECK(table.see(seen_node("late", "late"), time_zero)
        == unassigned_node_table::sighting::ignored);
  CHECK(table.size() == limits::unauthenticated_peers::unassigned_nodes);
  CHECK(table.see(seen_node("n", "u5", 2), time_zero)
        == unassigned_node_table::sighting::changed);
  table.vanish(seen_node("n", "u5", 2), 7000);
  CHECK(table.see(seen_node("late", "late"), time_zero)
        == unassigned_node_table::sighting::appeared);
}

TEST_CASE("A node is asked for a proof only where something hangs on its word",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1"), time_zero);
  table.see(seen_node("leg", "u2"), time_zero);
  const auto only_leg = [](const node_presence& x) { return x.name == "leg"; };
  CHECK(table.next_question(only_leg) <= time_zero);
  const auto asked = table.begin_questions(only_leg, time_zero);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].uuid == "u2");
  CHECK(table.begin_questions(only_leg, time_zero).empty());
  CHECK(table.question_answered("u2"));
}

TEST_CASE("A node that gives no proof is asked ever more seldom",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1"), time_zero);
  auto now = time_zero;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(table.begin_questions(always, now).size() == 1);
    table.question_failed("u1", "no proof", now);
    now = table.next_question(always);
  }
  CHECK(now - time_zero > 60s);
  CHECK(table.begin_questions(always, now - 1ms).empty());
  // Something new is worth a question.
  table.see(seen_node("arm", "u1", 2), now - 1ms);
  CHECK(table.begin_questions(always, now - 1ms).size() == 1);
}

TEST_CASE("The answer of a node that has gone meanwhile counts for nothing",
          "[unassigned_node_table]") {
  unassigned_node_table table;
  table.see(seen_node("arm", "u1"), time_zero);
  REQUIRE(table.begin_questions(always, time_zero).size() == 1);
  table.vanish(seen_node("arm", "u1"), 7000);
  CHECK_FALSE(table.question_answered("u1"));
}

TEST_CASE("Few nodes are asked at a time", "[unassigned_node_table]") {
  unassigned_node_table table;
  for (int i = 0; i < 10; ++i)
    table.see(seen_node("n", "u" + std::to_string(i)), time_zero);
  CHECK(table.begin_questions(always, time_zero).size()
        == limits::unauthenticated_peers::proof_calls);
  CHECK(table.begin_questions(always, time_zero).empty());
}

} // namespace roscell::test
