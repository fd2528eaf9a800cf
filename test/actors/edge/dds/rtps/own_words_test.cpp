#include "actors/edge/dds/rtps/own_words.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

using datagram = std::vector<std::uint8_t>;

std::optional<own_words> words_in(datagram x) {
  return own_words_in(x.data(), x.size());
}

datagram question() {
  return probe_question(make_probe_prefix(), sockaddr_in{});
}

} // namespace

TEST_CASE("who asks is known by the name, who answers by the announcement",
          "[discovery]") {
  const auto asks = words_in(question());
  REQUIRE(asks);
  CHECK(asks->name == probe_name);
  CHECK(asks->announcement.empty());
  for (const char* what : {"", "a", "four", "roscell=1.0;role=coordinator;"}) {
    const auto answers = words_in(probe_reply(server_prefix(3), what));
    REQUIRE(answers);
    CHECK(answers->name.empty());
    CHECK(answers->announcement == what);
  }
}

TEST_CASE("only what a participant tells of itself are its own words",
          "[discovery]") {
  const auto data = probe_reply(server_prefix(3), "hello");
  auto of_another = data;
  of_another[10] = 4; // The sender is server 4.
  CHECK_FALSE(words_in(of_another));
  auto of_a_topic = data;
  of_a_topic[34] = 3; // The writer's id, 0x000100c2, becomes 0x000300c2.
  CHECK_FALSE(words_in(of_a_topic));
  auto heartbeat = data;
  heartbeat[20] = 7;
  CHECK_FALSE(words_in(heartbeat));
  CHECK_FALSE(words_in(probe_farewell(make_probe_prefix())));
  // They may come behind something else.
  auto second = data;
  second.insert(second.begin() + 20, {9, 3, 0, 0});
  CHECK(words_in(second));
}

TEST_CASE("words that are cut off anywhere are none", "[discovery]") {
  for (const auto& data : {question(), probe_reply(server_prefix(3), "hello")})
    for (std::size_t size = 0; size < data.size(); ++size)
      CHECK_FALSE(words_in({data.begin(), data.begin() + size}));
}
