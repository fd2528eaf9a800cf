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

using namespace std::chrono_literals;

namespace {

constexpr auto once = speaker_lives::numbers_a_life;

guid_prefix speaker_number(std::size_t n) {
  return {1, 0x0f, static_cast<std::uint8_t>(n >> 8),
          static_cast<std::uint8_t>(n)};
}

} // namespace

TEST_CASE("who speaks after a silence is numbered above all from before") {
  speaker_lives lives;
  const auto a = speaker_number(1);
  const auto b = speaker_number(2);
  const speaker_lives::time_point start{};
  CHECK(lives.hear(a, start) == 0);
  CHECK(lives.hear(b, start) == 0);
  auto now = start;
  for (int i = 0; i < 9; ++i)
    CHECK(lives.hear(a, now += speaker_lives::silence - 1ms) == 0);
  CHECK(lives.hear(a, now += speaker_lives::silence) == once);
  CHECK(lives.hear(a, now += 4s) == once);
  CHECK(lives.hear(a, now += 45s) == 2 * once);
  CHECK(lives.hear(b, now) == once);
}

TEST_CASE("of too many speakers the most silent one is forgotten") {
  speaker_lives lives;
  speaker_lives::time_point now{};
  for (std::size_t n = 0; n < speaker_lives::most; ++n)
    lives.hear(speaker_number(n), now += 1ms);
  now += speaker_lives::silence;
  CHECK(lives.hear(speaker_number(0), now) == once);
  lives.hear(speaker_number(speaker_lives::most), now);
  CHECK(lives.hear(speaker_number(0), now) == once);
  CHECK(lives.hear(speaker_number(2), now) == once);
  CHECK(lives.hear(speaker_number(1), now) == 0);
}
