#include "actors/edge/dds/lives/introduction_pacing.hpp"

#include <catch2/catch.hpp>

#include <vector>

using namespace roscell;
using namespace std::chrono_literals;

namespace {

constexpr auto first = introduction_pacing::first_pause;
constexpr auto longest = introduction_pacing::longest_pause;

/// After how long the one after each of `count` introductions may follow.
std::vector<std::chrono::milliseconds>
pauses(introduction_pacing& pacing, introduction_pacing::time_point start,
       std::size_t count) {
  std::vector<std::chrono::milliseconds> result;
  auto now = start;
  while (result.size() < count) {
    const auto last = now;
    do
      now += 1ms;
    while (!pacing.ask(7, now) && now - last < 2 * longest);
    result.push_back(
        std::chrono::duration_cast<std::chrono::milliseconds>(now - last));
  }
  return result;
}

} // namespace

TEST_CASE("each pause between introductions is twice as long, up to a limit") {
  introduction_pacing pacing;
  const auto start = introduction_pacing::time_point{} + 1h;
  CHECK(pacing.ask(7, start));
  CHECK(pauses(pacing, start, 7)
        == std::vector<std::chrono::milliseconds>{first, 2 * first, 4 * first,
                                                  8 * first, 16 * first,
                                                  longest, longest});
}

TEST_CASE("who had nothing to say for long is not made to wait") {
  introduction_pacing pacing;
  auto now = introduction_pacing::time_point{} + 1h;
  pacing.ask(7, now);
  pauses(pacing, now, 7);
  // When the last one was.
  now += 31 * first + 2 * longest;
  SECTION("as long as the longest pause, and one more") {
    now += 2 * longest;
    CHECK(pacing.ask(7, now));
    CHECK_FALSE(pacing.ask(7, now + first - 1ms));
    CHECK(pacing.ask(7, now + first));
  }
  SECTION("a little less") {
    now += 2 * longest - 1ms;
    CHECK(pacing.ask(7, now));
    CHECK_FALSE(pacing.ask(7, now + longest - 1ms));
  }
}

TEST_CASE("each server has a pace of its own, which ends with its life") {
  introduction_pacing pacing;
  const auto now = introduction_pacing::time_point{} + 1h;
  CHECK(pacing.ask(7, now));
  CHECK(pacing.ask(8, now));
  CHECK_FALSE(pacing.ask(7, now));
  pacing.forget(7);
  CHECK(pacing.ask(7, now));
  CHECK_FALSE(pacing.ask(8, now));
}
