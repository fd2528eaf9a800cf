#include "actors/edge/dds/lives/speaker_lives.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"
#include "test/actors/edge/dds/lives/addressed.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <vector>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

constexpr auto once = speaker_lives::numbers_a_life;

guid_prefix speaker_number(std::size_t n) {
  return {1, 0x0f, static_cast<std::uint8_t>(n >> 8),
          static_cast<std::uint8_t>(n)};
}

/// The number in the identity of the sample of a message with one DATA.
std::int64_t identity_in(std::vector<std::uint8_t> message,
                         const guid_prefix& author) {
  const auto at = std::search(message.begin() + rtps_header_bytes,
                              message.end(), author.begin(), author.end());
  REQUIRE(message.end() - at >= 24);
  wire_cursor in{&*at, 24};
  in.skip(16);
  return in.sequence_number();
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

TEST_CASE("what is raised is a participant's own word, and not of its end") {
  const auto who = make_probe_prefix();
  auto word = probe_question(who, {});
  const auto before = identity_in(word, who);
  raise_own_news(word.data(), word.size(), once);
  CHECK(identity_in(word, who) == before + once);
  auto passed_on = probe_question(who, {});
  const auto server = server_prefix(7);
  std::copy(server.begin(), server.end(), passed_on.begin() + rtps_sender_at);
  for (auto other : {probe_farewell(who), passed_on}) {
    const auto same = other;
    raise_own_news(other.data(), other.size(), once);
    CHECK(other == same);
  }
}
