#include "actors/cell/tables/unauthenticated_calls.hpp"
#include "actors/core/limits.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

} // namespace

TEST_CASE(
    "No more unauthenticated peers are called at a time than there are slots",
    "[unauthenticated_calls]") {
  unauthenticated_calls calls{2};
  CHECK(calls.begin("a", time_zero));
  CHECK_FALSE(calls.begin("a", time_zero));
  CHECK(calls.begin("b", time_zero));
  CHECK_FALSE(calls.begin("c", time_zero));
  CHECK(calls.next("c") == unauthenticated_calls::time_point::max());
  CHECK(calls.succeed("a"));
  CHECK(calls.next("c") <= time_zero);
  CHECK(calls.begin("c", time_zero));
  CHECK(calls.running() == 2);
}

TEST_CASE("A failed call keeps its slot for a second",
          "[unauthenticated_calls]") {
  unauthenticated_calls calls{1};
  REQUIRE(calls.begin("a", time_zero));
  calls.fail("a", "refused", time_zero);
  CHECK_FALSE(calls.begin("b", time_zero + 999ms));
  CHECK(calls.next("b") == time_zero + 1s);
  CHECK(calls.begin("b", time_zero + 1s));
}

TEST_CASE("Whoever does not answer is called ever more seldom",
          "[unauthenticated_calls]") {
  unauthenticated_calls calls{8};
  auto now = time_zero;
  auto last = 0ms;
  for (unsigned i = 0; i < 12; ++i) {
    REQUIRE(calls.begin("a", now));
    CHECK(calls.fail("a", "refused", now) == (i == 0));
    CHECK(calls.failures("a") == i + 1);
    const auto pause = std::chrono::duration_cast<std::chrono::milliseconds>(
        calls.next("a") - now);
    CHECK(pause <= limits::retry::longest);
    CHECK_FALSE(calls.begin("a", calls.next("a") - 1ms));
    last = pause;
    now = calls.next("a");
  }
  CHECK(last >= limits::retry::longest / 2);
  CHECK(calls.problem("a") == "refused");
  REQUIRE(calls.begin("a", now));
  CHECK(calls.succeed("a"));
  CHECK(calls.failures("a") == 0);
}

TEST_CASE("News of an unauthenticated peer end its pause",
          "[unauthenticated_calls]") {
  unauthenticated_calls calls{8};
  REQUIRE(calls.begin("a", time_zero));
  calls.fail("a", "refused", time_zero);
  calls.hurry("a", time_zero);
  CHECK(calls.begin("a", time_zero));
  CHECK(calls.failures("a") == 1);
}

TEST_CASE("Of an unauthenticated peer that was forgotten nothing is kept",
          "[unauthenticated_calls]") {
  unauthenticated_calls calls{1};
  REQUIRE(calls.begin("a", time_zero));
  calls.forget("a");
  // The connection is still being opened.
  CHECK_FALSE(calls.begin("b", time_zero));
  CHECK_FALSE(calls.fail("a", "refused", time_zero));
  CHECK(calls.failures("a") == 0);
  CHECK(calls.begin("b", time_zero + 1s));
  calls.forget("b");
  CHECK_FALSE(calls.succeed("b"));
}

TEST_CASE("Who is announced again while it is called is wanted again",
          "[unauthenticated_calls]") {
  unauthenticated_calls calls{1};
  REQUIRE(calls.begin("a", time_zero));
  calls.forget("a");
  calls.hurry("a", time_zero);
  CHECK(calls.succeed("a"));
}

} // namespace roscell::test
