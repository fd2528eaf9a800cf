#include "actors/cell/limits.hpp"
#include "actors/cell/tables/ordered_ends.hpp"
#include "actors/core/answer_limits.hpp"
#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

ordered_ends::time_point hour_and(std::chrono::milliseconds x) {
  return ordered_ends::time_point{1h + x};
}

end_order order_of(const std::string& instance, int64_t priority = 5) {
  return {instance, "it is preempted by task 'high'", "high", priority};
}

constexpr auto never = ordered_ends::time_point::max();

} // namespace

TEST_CASE("What was told to end is started anew once nobody needs its room",
          "[ordered_ends]") {
  ordered_ends x;
  x.add("low", order_of("i"));
  CHECK_FALSE(x.is_asked("i"));
  x.ask("i");
  CHECK(x.is_asked("i"));
  const bool ends_late = GENERATE(false, true);
  if (ends_late) {
    x.let_go_of("high", hour_and(0s));
    CHECK(x.next_due() == never);
    x.end("i", hour_and(1s));
  } else {
    x.end("i", hour_and(0s));
    CHECK(x.next_due() == never);
    x.let_go_of("other", hour_and(1s));
    CHECK(x.next_due() == never);
    x.let_go_of("high", hour_and(1s));
  }
  CHECK(x.next_due() == hour_and(1s));
  const auto due = x.take_due(hour_and(1s));
  REQUIRE(due.size() == 1);
  CHECK(due[0].task == "low");
  // It is being started.
  CHECK(x.take_due(hour_and(1h)).empty());
}

TEST_CASE("Those of the highest priority are started first", "[ordered_ends]") {
  ordered_ends x;
  x.add("low", order_of("i", 2));
  x.add("mid", order_of("j", 4));
  for (const auto* instance : {"i", "j"}) {
    x.ask(instance);
    x.end(instance, hour_and(0s));
  }
  x.let_go_of("high", hour_and(0s));
  const auto due = x.take_due(hour_and(0s));
  REQUIRE(due.size() == 2);
  CHECK(due[0].task == "mid");
}

TEST_CASE("What has no place is tried once, or while nodes come back",
          "[ordered_ends]") {
  ordered_ends x;
  SECTION("once") {
    x.add("low", order_of("i"));
    x.end("i", hour_and(0s));
    x.let_go("i", hour_and(0s));
    REQUIRE(x.take_due(hour_and(0s)).size() == 1);
    CHECK_FALSE(x.postpone("i", false, hour_and(0s)));
    // What is busy is none of its fault, for some time.
    CHECK(x.postpone("i", true, hour_and(limits::task::eviction - 1ms)));
    CHECK_FALSE(x.postpone("i", true, hour_and(limits::task::eviction)));
  }
  SECTION("while nodes come back after a restart") {
    x.restore("low", order_of("i"), true, hour_and(0s));
    constexpr auto span = limits::task::return_of_nodes;
    REQUIRE(x.take_due(hour_and(0s)).size() == 1);
    CHECK(x.postpone("i", false, hour_and(span - 1ms)));
    CHECK(x.next_due() > hour_and(span - 1ms));
    CHECK_FALSE(x.postpone("i", false, hour_and(span)));
  }
}

TEST_CASE("After a restart an order stands until its instance has ended",
          "[ordered_ends]") {
  ordered_ends x;
  x.restore("low", order_of("i"), false, hour_and(0s));
  CHECK(x.is_asked("i"));
  CHECK(x.next_due() == never);
  x.end("i", hour_and(1h));
  CHECK(x.take_due(hour_and(1h)).size() == 1);
  CHECK(x.postpone("i", false, hour_and(1h + 1s)));
}

TEST_CASE("What its task has no order for any more is forgotten",
          "[ordered_ends]") {
  ordered_ends x;
  x.add("low", order_of("i"));
  x.add("low", order_of("j"));
  x.add("other", order_of("k"));
  x.keep_only("low", {order_of("j")});
  CHECK(x.find("i") == nullptr);
  CHECK(x.find("j") != nullptr);
  CHECK(x.size() == 2);
  x.keep_only("other", {});
  CHECK(x.size() == 1);
}

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

TEST_CASE("What has had no place can be hurried", "[ordered_ends]") {
  ordered_ends x;
  x.restore("low", order_of("i"), true, hour_and(0s));
  REQUIRE(x.take_due(hour_and(0s)).size() == 1);
  x.hurry(hour_and(0s));
  CHECK(x.next_due() == never); // It is being started.
  REQUIRE(x.postpone("i", false, hour_and(1s)));
  REQUIRE(x.next_due() > hour_and(1s));
  x.hurry(hour_and(1s));
  CHECK(x.next_due() == hour_and(1s));
}

} // namespace roscell::test
