#include "actors/cell/limits.hpp"
#include "actors/cell/tables/removal_table.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

} // namespace

TEST_CASE("A removal is asked for again after ever longer pauses",
          "[removal_table]") {
  removal_table table;
  CHECK(table.next_due() == removal_table::time_point::max());
  auto now = time_zero;
  auto before = 0ms;
  for (int i = 0; i < 4; ++i) {
    table.add({"n", "t", "t-0"}, now);
    CHECK(table.take_due(now).empty());
    const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(
        table.next_due() - now);
    CHECK(pause >= before);
    before = pause;
    now = table.next_due();
    REQUIRE(table.take_due(now).size() == 1);
    // It is being asked for.
    CHECK(table.take_due(now + 1h).empty());
  }
}

TEST_CASE("What was removed is asked for no more", "[removal_table]") {
  removal_table table;
  table.add({"n", "t", "t-0"}, time_zero);
  table.add({"n", "t", "t-1"}, time_zero);
  table.add({"m", "t", "t-2"}, time_zero);
  table.settle({"n", "t", "t-0"});
  CHECK(table.size() == 2);
  table.forget_node("n");
  const auto left = table.take_due(time_zero + 1h);
  REQUIRE(left.size() == 1);
  CHECK(left[0].node == "m");
  CHECK(left[0].task == "t");
  CHECK(left[0].instance == "t-2");
}

TEST_CASE("Overdue removals are bounded", "[removal_table]") {
  removal_table table;
  for (size_t i = 0; i < limits::task::overdue_removals + 10; ++i)
    table.add({"n", "t", std::to_string(i)}, time_zero);
  CHECK(table.size() == limits::task::overdue_removals);
}

} // namespace roscell::test
