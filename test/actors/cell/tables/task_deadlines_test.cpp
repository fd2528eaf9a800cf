#include "actors/cell/tables/task_deadlines.hpp"

#include <catch2/catch.hpp>

/// The table of when tasks are to have ended.
namespace roscell::test {

namespace {

using namespace std::chrono_literals;

const task_deadlines::time_point at_first{1h};

struct deadlines {
  task_deadlines table;

  size_t due(task_deadlines::time_point now) {
    return table.take_due(now).size();
  }
};

} // namespace

TEST_CASE_METHOD(deadlines, "A deadline is due at its time and not before",
                 "[late_tasks]") {
  CHECK(table.next_due() == task_deadlines::time_point::max());
  table.follow("a", 61'000, 1000, at_first);
  CHECK(table.next_due() == at_first + 60s);
  CHECK(due(at_first + 60s - 1ms) == 0);
  CHECK_FALSE(table.is_late("a"));
  const auto late = table.take_due(at_first + 60s);
  REQUIRE(late.size() == 1);
  CHECK(late[0].task == "a");
  CHECK(late[0].is_first);
  CHECK(table.is_late("a"));
}

TEST_CASE_METHOD(deadlines, "A deadline that is over already is due at once",
                 "[late_tasks]") {
  table.follow("a", 1000, 61'000, at_first);
  CHECK(due(at_first) == 1);
}

TEST_CASE_METHOD(deadlines,
                 "What is late is due again after a pause, or when "
                 "something has come back",
                 "[late_tasks]") {
  table.follow("a", 1000, 1000, at_first);
  table.follow("b", 90'000, 1000, at_first);
  REQUIRE(due(at_first) == 1);
  CHECK(due(at_first) == 0);
  table.hurry(at_first);
  const auto late = table.take_due(at_first);
  REQUIRE(late.size() == 1);
  CHECK_FALSE(late[0].is_first);
  CHECK(due(at_first + 60s) == 1);
}

TEST_CASE_METHOD(deadlines, "The same deadline again changes nothing",
                 "[late_tasks]") {
  table.follow("a", 61'000, 1000, at_first);
  // The wall clock has been set meanwhile.
  table.follow("a", 61'000, 60'000, at_first + 10s);
  CHECK(table.next_due() == at_first + 60s);
  REQUIRE(due(at_first + 60s) == 1);
  table.follow("a", 61'000, 61'000, at_first + 60s);
  CHECK(table.is_late("a"));
}

TEST_CASE_METHOD(deadlines, "What has ended is not late", "[late_tasks]") {
  table.follow("a", 61'000, 1000, at_first);
  REQUIRE(due(at_first + 60s) == 1);
  table.follow("a", 0, 61'000, at_first + 60s);
  CHECK_FALSE(table.is_late("a"));
  CHECK(table.next_due() == task_deadlines::time_point::max());
  table.follow("a", 200'000, 100'000, at_first + 99s);
  CHECK_FALSE(table.is_late("a"));
  CHECK(table.next_due() == at_first + 199s);
}

} // namespace roscell::test
