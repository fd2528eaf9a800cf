#include "actors/edge/dds/rtps/probe_responder.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"

#include <catch2/catch.hpp>

#include <array>

#include <sys/socket.h>

using namespace roscell;

namespace {

using datagram = std::vector<std::uint8_t>;

udp_socket any_socket() {
  return std::get<udp_socket>(udp_socket::bind("127.0.0.1", 0));
}

/// Who asks, and the one who answers in the place of server 3.
struct asked_responder {
  udp_socket asks = any_socket();
  probe_responder answers{any_socket()};

  asked_responder() {
    answers.speak_for(server_prefix(3), "hello");
  }

  bool take(datagram x) {
    return answers.take(x.data(), x.size(), asks.local());
  }

  /// What has come of an answer; empty: none.
  datagram answer() const {
    std::array<std::uint8_t, 2048> result{};
    const auto size = recv(asks.fd(), result.data(), result.size(), 0);
    return {result.begin(), result.begin() + std::max<ssize_t>(size, 0)};
  }
};

} // namespace

TEST_CASE("a question is answered at once, and Fast DDS hears neither it nor "
          "its farewell",
          "[discovery]") {
  asked_responder x;
  const auto who = make_probe_prefix();
  CHECK(x.take(probe_question(who, x.asks.local())));
  auto got = x.answer();
  CHECK(probe_answer(got.data(), got.size()) == server_prefix(3));
  const auto said = own_announcement_in(got.data(), got.size());
  REQUIRE(said);
  CHECK(said->announcement == "hello");
  CHECK(x.take(probe_farewell(who)));
  CHECK(x.answer().empty());
}

TEST_CASE("others than those who ask are for Fast DDS", "[discovery]") {
  asked_responder x;
  CHECK_FALSE(x.take(probe_farewell(make_probe_prefix())));
  CHECK_FALSE(x.take(probe_reply(server_prefix(4), "of a server")));
  CHECK_FALSE(x.take({'R', 'T', 'P', 'S'}));
  CHECK(x.answer().empty());
}

TEST_CASE("until it knows for whom it speaks every question is for Fast DDS",
          "[discovery]") {
  asked_responder x;
  probe_responder silent{any_socket()};
  auto asks = probe_question(make_probe_prefix(), x.asks.local());
  CHECK_FALSE(silent.take(asks.data(), asks.size(), x.asks.local()));
  CHECK(x.answer().empty());
}

TEST_CASE("a flood of questions costs a bounded memory", "[discovery]") {
  asked_responder x;
  const auto first = make_probe_prefix();
  x.take(probe_question(first, x.asks.local()));
  for (std::size_t n = 1; n < probe_responder::most_remembered; ++n)
    x.take(probe_question(make_probe_prefix(), x.asks.local()));
  CHECK(x.take(probe_farewell(first)));
  x.take(probe_question(make_probe_prefix(), x.asks.local()));
  CHECK_FALSE(x.take(probe_farewell(first)));
}
