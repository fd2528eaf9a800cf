#include "actors/edge/dds/lives/server_lives.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"
#include "test/actors/edge/dds/lives/addressed.hpp"

#include <catch2/catch.hpp>

#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr std::uint8_t own = 3;
constexpr std::uint8_t other = 7;

const server_lives::time_point met_at{std::chrono::hours{1}};
const auto heard_at = met_at + server_lives::settling;

/// Server `id` tells of its own end.
std::vector<std::uint8_t> word_of(std::uint8_t id) {
  return death_notice(server_prefix(id), 5, server_prefix(id));
}

guid_prefix key_in(std::vector<std::uint8_t>& message) {
  const auto news = participants_in(message.data(), message.size());
  REQUIRE(news.size() == 1);
  return news.front().who;
}

} // namespace

TEST_CASE("each life of another server is another participant") {
  server_lives lives{own};
  std::vector<guid_prefix> seen;
  for (int life = 0; life < 4; ++life) {
    auto message = word_of(other);
    REQUIRE(lives.take_in(message.data(), message.size(), heard_at));
    const auto known_as = sender_of(message.data());
    CHECK(known_as == lives.present(other));
    CHECK(key_in(message) == known_as);
    CHECK(lives.is_another_server(known_as));
    CHECK(server_lives::id_of(known_as) == other);
    CHECK(std::count(seen.begin(), seen.end(), known_as) == 0);
    seen.push_back(known_as);
    lives.lose(other);
    lives.meet(other, met_at);
  }
}

TEST_CASE("on the wire a server has the same prefix in all its lives") {
  server_lives lives{own};
  for (int life = 0; life < 3; ++life) {
    const auto inside = lives.present(other);
    auto message = death_notice(server_prefix(own), 5, inside);
    REQUIRE(lives.let_out(message.data(), message.size()));
    CHECK(key_in(message) == server_prefix(other));
    lives.lose(other);
  }
}

TEST_CASE("the own prefix is never changed") {
  server_lives lives{own};
  lives.lose(own);
  auto message = word_of(own);
  CHECK(lives.let_out(message.data(), message.size()));
  CHECK(message == word_of(own));
  CHECK_FALSE(lives.is_another_server(server_prefix(own)));
}

TEST_CASE("nothing is heard of a lost server until it is met") {
  server_lives lives{own};
  lives.lose(other);
  auto message = word_of(other);
  CHECK_FALSE(lives.take_in(message.data(), message.size(), heard_at));
  auto neighbour = word_of(other + 1);
  CHECK(lives.take_in(neighbour.data(), neighbour.size(), heard_at));
  lives.meet(other, met_at);
  message = word_of(other);
  CHECK(lives.take_in(message.data(), message.size(), heard_at));
}

TEST_CASE(
    "what is on its way of a life that was lost is not heard in the next") {
  server_lives lives{own};
  const auto hears = [&lives](server_lives::time_point when) {
    auto message = word_of(other);
    return lives.take_in(message.data(), message.size(), when);
  };
  lives.meet(other, met_at);
  CHECK(hears(met_at)); // There was no life before.
  lives.lose(other);
  lives.meet(other, met_at);
  CHECK_FALSE(hears(met_at));
  CHECK_FALSE(hears(heard_at - std::chrono::milliseconds{1}));
  CHECK(hears(heard_at));
}

TEST_CASE("a life has spoken once something of it was let in") {
  server_lives lives{own};
  const auto hear = [&lives](server_lives::time_point when) {
    auto message = word_of(other);
    lives.take_in(message.data(), message.size(), when);
  };
  CHECK_FALSE(lives.has_spoken(other));
  hear(met_at);
  CHECK(lives.has_spoken(other));
  CHECK_FALSE(lives.has_spoken(other + 1));
  lives.lose(other);
  hear(met_at); // It is not met.
  CHECK_FALSE(lives.has_spoken(other));
}

TEST_CASE("who was met is so until it is lost") {
  server_lives lives{own};
  CHECK_FALSE(lives.is_met(other));
  lives.meet(other, met_at);
  CHECK(lives.is_met(other));
  CHECK_FALSE(lives.is_met(other + 1));
  lives.lose(other);
  CHECK_FALSE(lives.is_met(other));
  lives.meet(other, met_at);
  CHECK(lives.is_met(other));
  lives.ignore(other);
  CHECK_FALSE(lives.is_met(other));
}

TEST_CASE("nothing goes to a life that has ended") {
  server_lives lives{own};
  const auto former = lives.present(other);
  lives.lose(other);
  lives.meet(other, met_at);
  auto late = addressed(word_of(own), former);
  CHECK_FALSE(lives.let_out(late.data(), late.size()));
  auto fresh = addressed(word_of(own), lives.present(other));
  REQUIRE(lives.let_out(fresh.data(), fresh.size()));
  CHECK(fresh == addressed(word_of(own), server_prefix(other)));
}

TEST_CASE("who is no discovery server goes through as it is") {
  server_lives lives{own};
  lives.lose(other);
  const auto who = make_probe_prefix();
  const auto message = death_notice(who, 5, who);
  auto came = message;
  CHECK(lives.take_in(came.data(), came.size(), heard_at));
  CHECK(came == message);
  auto goes = message;
  CHECK(lives.let_out(goes.data(), goes.size()));
  CHECK(goes == message);
  CHECK_FALSE(lives.is_another_server(who));
}

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
