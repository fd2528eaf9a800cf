#include "actors/cell/books/free_node_book.hpp"

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

TEST_CASE("A free node is told as it announced itself last",
          "[free_node_book]") {
  free_node_book book;
  CHECK(book.see(seen_node("arm", "u1"), time_zero)
        == free_node_book::sighting::appeared);
  CHECK(book.see(seen_node("arm", "u1"), time_zero)
        == free_node_book::sighting::repeated);
  CHECK(book.see(seen_node("arm", "u1", 2, "orphaned"), time_zero)
        == free_node_book::sighting::changed);
  const auto rows = book.rows();
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].name == "arm");
  CHECK(rows[0].state == node_state::orphaned);
}

TEST_CASE("A farewell of an earlier life drops nobody", "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1", 2), time_zero);
  CHECK_FALSE(book.vanish(seen_node("arm", "u1", 1), 7000));
  CHECK_FALSE(book.vanish(seen_node("arm", "u1", 2, "orphaned"), 7000));
  CHECK_FALSE(book.vanish(seen_node("leg", "u2", 2), 7000));
  CHECK(book.find("u1"));
  CHECK(book.vanish(seen_node("arm", "u1", 2), 7000));
  CHECK_FALSE(book.find("u1"));
}

TEST_CASE("A node that has fallen silent says since when, until it is back",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1"), time_zero);
  CHECK(book.rows()[0].silent_since_unix_ms == 0);
  CHECK(book.vanish(seen_node("arm", "u1"), 5000));
  REQUIRE(book.rows().size() == 1);
  CHECK(book.rows()[0].name == "arm");
  CHECK(book.rows()[0].silent_since_unix_ms == 5000);
  CHECK(book.size() == 0);
  SECTION("it announces itself") {
    book.see(seen_node("arm", "u1"), time_zero);
    REQUIRE(book.rows().size() == 1);
    CHECK(book.rows()[0].silent_since_unix_ms == 0);
  }
  SECTION("it registers here") {
    book.registered({"arm", "u1", 1, ""});
    CHECK(book.rows().empty());
  }
}

TEST_CASE("Of the silent nodes the last ones are remembered",
          "[free_node_book]") {
  free_node_book book;
  for (size_t i = 0; i <= limits::strangers::silent_nodes; ++i) {
    const auto node = seen_node("n", "u" + std::to_string(i));
    book.see(node, time_zero);
    book.vanish(node, static_cast<int64_t>(i) + 1);
  }
  const auto rows = book.rows();
  CHECK(rows.size() == limits::strangers::silent_nodes);
  CHECK(std::none_of(rows.begin(), rows.end(),
                     [](const auto& x) { return x.uuid == "u0"; }));
}

TEST_CASE("Looking for a node that announced nothing makes none",
          "[free_node_book]") {
  free_node_book book;
  CHECK_FALSE(book.find("u1"));
  book.forget("u1");
  book.question_failed("u1", "silent", time_zero);
  CHECK(book.rows().empty());
  book.registered({"arm", "u1", 1, ""});
  CHECK(book.rows().empty());
}

TEST_CASE("Of two nodes with one name the newer epoch counts",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1", 5), time_zero);
  book.see(seen_node("arm", "u2", 3), time_zero);
  REQUIRE(book.find_name("arm"));
  CHECK(book.find_name("arm")->uuid == "u1");
  CHECK_FALSE(book.find_name("leg"));
}

TEST_CASE("A registration ends what was announced before it",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1", 5), time_zero);
  book.registered({"arm", "u1", 5, ""});
  CHECK(book.find("u1"));
  book.registered({"arm", "u1", 6, ""});
  CHECK_FALSE(book.find("u1"));
}

TEST_CASE("Strangers fill no more than a bound", "[free_node_book]") {
  free_node_book book;
  for (size_t i = 0; i < limits::strangers::free_nodes; ++i)
    book.see(seen_node("n", "u" + std::to_string(i)), time_zero);
  CHECK(book.see(seen_node("late", "late"), time_zero)
        == free_node_book::sighting::ignored);
  CHECK(book.size() == limits::strangers::free_nodes);
  CHECK(book.see(seen_node("n", "u5", 2), time_zero)
        == free_node_book::sighting::changed);
  book.vanish(seen_node("n", "u5", 2), 7000);
  CHECK(book.see(seen_node("late", "late"), time_zero)
        == free_node_book::sighting::appeared);
}

TEST_CASE("A node is asked for a proof only where something hangs on its word",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1"), time_zero);
  book.see(seen_node("leg", "u2"), time_zero);
  const auto only_leg = [](const node_presence& x) { return x.name == "leg"; };
  CHECK(book.next_question(only_leg) <= time_zero);
  const auto asked = book.begin_questions(only_leg, time_zero);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].uuid == "u2");
  CHECK(book.begin_questions(only_leg, time_zero).empty());
  CHECK(book.question_answered("u2"));
}

TEST_CASE("A node that gives no proof is asked ever more seldom",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1"), time_zero);
  auto now = time_zero;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(book.begin_questions(always, now).size() == 1);
    book.question_failed("u1", "no proof", now);
    now = book.next_question(always);
  }
  CHECK(now - time_zero > 60s);
  CHECK(book.begin_questions(always, now - 1ms).empty());
  // Something new is worth a question.
  book.see(seen_node("arm", "u1", 2), now - 1ms);
  CHECK(book.begin_questions(always, now - 1ms).size() == 1);
}

TEST_CASE("The answer of a node that has gone meanwhile counts for nothing",
          "[free_node_book]") {
  free_node_book book;
  book.see(seen_node("arm", "u1"), time_zero);
  REQUIRE(book.begin_questions(always, time_zero).size() == 1);
  book.vanish(seen_node("arm", "u1"), 7000);
  CHECK_FALSE(book.question_answered("u1"));
}

TEST_CASE("Few nodes are asked at a time", "[free_node_book]") {
  free_node_book book;
  for (int i = 0; i < 10; ++i)
    book.see(seen_node("n", "u" + std::to_string(i)), time_zero);
  CHECK(book.begin_questions(always, time_zero).size()
        == limits::strangers::proof_calls);
  CHECK(book.begin_questions(always, time_zero).empty());
}

} // namespace roscell::test
