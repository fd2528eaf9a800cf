#include "actors/edge/dds/lives/speaker_lives.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
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
