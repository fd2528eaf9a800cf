#include "roscell/skill/pacer.hpp"

#include <catch2/catch.hpp>

using namespace roscell::engine;

TEST_CASE("a live input gets a turn per period, one without a rate always") {
  pacer slow{0.001};
  CHECK(slow.take_turn());
  CHECK_FALSE(slow.take_turn());
  pacer unlimited{0};
  CHECK(unlimited.take_turn());
  CHECK(unlimited.take_turn());
}
