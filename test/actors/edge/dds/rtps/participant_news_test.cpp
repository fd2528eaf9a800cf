#include "actors/edge/dds/rtps/participant_news.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <vector>

using namespace roscell;

namespace {

using datagram = std::vector<std::uint8_t>;

std::optional<own_announcement> words_in(datagram x) {
  return own_announcement_in(x.data(), x.size());
}

datagram question() {
  return probe_question(make_probe_prefix(), sockaddr_in{});
}

/// The number in the identity of the sample of a message with one DATA.
std::int64_t identity_in(datagram message, const guid_prefix& author) {
  const auto at = std::search(message.begin() + rtps_header_bytes,
                              message.end(), author.begin(), author.end());
  REQUIRE(message.end() - at >= 24);
  wire_cursor in{&*at, 24};
  in.skip(16);
  return in.sequence_number();
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

TEST_CASE("what is raised is a participant's own word, and not of its end") {
  const auto who = make_probe_prefix();
  auto word = probe_question(who, {});
  constexpr std::int64_t raised = std::int64_t{1} << 32;
  const auto before = identity_in(word, who);
  raise_own_news(word.data(), word.size(), raised);
  CHECK(identity_in(word, who) == before + raised);
  auto passed_on = probe_question(who, {});
  const auto server = server_prefix(7);
  std::copy(server.begin(), server.end(), passed_on.begin() + rtps_sender_at);
  for (auto other : {probe_farewell(who), passed_on}) {
    const auto same = other;
    raise_own_news(other.data(), other.size(), raised);
    CHECK(other == same);
  }
}
