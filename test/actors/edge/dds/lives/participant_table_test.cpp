#include "actors/edge/dds/lives/participant_table.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

guid_prefix nth(unsigned n) {
  return {1, 0x0f, static_cast<std::uint8_t>(n >> 16),
          static_cast<std::uint8_t>(n >> 8), static_cast<std::uint8_t>(n)};
}

using found = std::vector<guid_prefix>;

} // namespace

TEST_CASE("what a server that is lost has told of is in doubt until it is told "
          "of again") {
  participant_table table;
  for (unsigned n = 1; n <= 3; ++n)
    table.reported_by(7, nth(n));
  table.reported_by(8, nth(4));
  CHECK(table.doubted(7).empty());
  table.doubt(7);
  CHECK(table.doubted(7) == found{nth(1), nth(2), nth(3)});
  CHECK(table.doubted(8).empty());
  table.reported_by(7, nth(2));
  CHECK(table.doubted(7) == found{nth(1), nth(3)});
  table.reported_by(8, nth(1)); // It has gone to another host.
  CHECK(table.doubted(7) == found{nth(3)});
  table.reported_itself(nth(3));
  CHECK(table.doubted(7).empty());
  CHECK(table.reported_by(7) == found{nth(2)});
}

TEST_CASE("who tells of itself is not known by what another server tells") {
  participant_table table;
  table.reported_itself(nth(1));
  table.appeared(nth(1));
  table.reported_by(7, nth(1));
  table.doubt(7);
  CHECK(table.doubted(7).empty());
  table.gone(nth(1));
  table.reported_by(7, nth(1));
  CHECK(table.reported_by(7) == found{nth(1)});
}

TEST_CASE("a flood of participants costs a bounded table") {
  participant_table table;
  for (unsigned n = 0; n < participant_table::most + 10; ++n)
    table.reported_by(7, nth(n));
  CHECK(table.reported_by(7).size() == participant_table::most);
  for (unsigned n = 0; n < participant_table::most + 10; ++n)
    table.appeared(nth(1'000'000 + n));
  // Those that are known can still be told of.
  table.reported_by(8, nth(0));
  CHECK(table.reported_by(8) == found{nth(0)});
}
