#include "actors/cell/books/removal_book.hpp"

#include "actors/house/limits.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

} // namespace

TEST_CASE("A removal is asked for again after ever longer pauses",
          "[removal_book]") {
  removal_book book;
  CHECK(book.next_due() == removal_book::time_point::max());
  auto now = time_zero;
  auto before = 0ms;
  for (int i = 0; i < 4; ++i) {
    book.add({"n", "t", "t-0"}, now);
    CHECK(book.take_due(now).empty());
    const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(
        book.next_due() - now);
    CHECK(pause >= before);
    before = pause;
    now = book.next_due();
    REQUIRE(book.take_due(now).size() == 1);
    // It is being asked for.
    CHECK(book.take_due(now + 1h).empty());
  }
}

TEST_CASE("What was removed is asked for no more", "[removal_book]") {
  removal_book book;
  book.add({"n", "t", "t-0"}, time_zero);
  book.add({"n", "t", "t-1"}, time_zero);
  book.add({"m", "t", "t-2"}, time_zero);
  book.settle({"n", "t", "t-0"});
  CHECK(book.size() == 2);
  book.forget_node("n");
  const auto left = book.take_due(time_zero + 1h);
  REQUIRE(left.size() == 1);
  CHECK(left[0].node == "m");
  CHECK(left[0].task == "t");
  CHECK(left[0].instance == "t-2");
}

TEST_CASE("Overdue removals are bounded", "[removal_book]") {
  removal_book book;
  for (size_t i = 0; i < limits::task::overdue_removals + 10; ++i)
    book.add({"n", "t", std::to_string(i)}, time_zero);
  CHECK(book.size() == limits::task::overdue_removals);
}

} // namespace roscell::test
