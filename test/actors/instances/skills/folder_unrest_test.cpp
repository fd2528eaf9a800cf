#include "actors/instances/skills/folder_unrest.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

folder_unrest::time_point moment(std::chrono::milliseconds x) {
  return folder_unrest::time_point{1h + x};
}

constexpr auto at_rest = folder_unrest::time_point::max();

} // namespace

TEST_CASE("folders are read once nobody has written there for a while") {
  folder_unrest x;
  CHECK(x.due() == at_rest);
  x.touch(moment(0ms));
  CHECK(x.due() == moment(300ms));
  x.touch(moment(250ms));
  CHECK(x.due() == moment(550ms));
  CHECK(x.begin_reading(moment(550ms)));
  CHECK(x.due() == at_rest);
}

TEST_CASE("folders that never rest are read all the same") {
  folder_unrest x;
  for (auto t = 0ms; t < 5000ms; t += 100ms)
    x.touch(moment(t));
  CHECK(x.due() == moment(5s));
  CHECK_FALSE(x.begin_reading(moment(5s)));
  SECTION("and again when they are quiet") {
    CHECK(x.due() == moment(4900ms + 300ms));
    CHECK(x.begin_reading(moment(5200ms)));
    CHECK(x.due() == at_rest);
  }
  SECTION("and again when they go on") {
    for (auto t = 5000ms; t < 12'000ms; t += 100ms)
      x.touch(moment(t));
    CHECK(x.due() == moment(10s));
  }
}
