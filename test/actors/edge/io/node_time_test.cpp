#include "actors/edge/io/node_time.hpp"

#include <catch2/catch.hpp>

TEST_CASE("a time is written in UTC with its milliseconds") {
  CHECK(roscell::iso_time(0) == "1970-01-01T00:00:00.000Z");
  CHECK(roscell::iso_time(1795366862345) == "2026-11-22T17:01:02.345Z");
  CHECK(roscell::iso_time(-1) == "1969-12-31T23:59:59.999Z");
}
