#include "actors/edge/reach/reach_port.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

std::string_view text_of(const std::vector<std::uint8_t>& x) {
  return {reinterpret_cast<const char*>(x.data()), x.size()};
}

std::string_view text_of(const reach_bytes& x) {
  return {x.data(), x.size()};
}

constexpr auto token = "a site token";
const auto key = reach_key(token);

} // namespace

TEST_CASE("who knows the site token is answered, once and shortly", "[reach]") {
  const auto nonce = make_reach_nonce();
  for (const size_t size : {size_t{0}, reach_packet_size, size_t{16384}}) {
    const auto question = reach_question(nonce, key, size);
    CHECK(question.size() == std::max(size, reach_packet_size));
    const auto answer = reach_answer(text_of(question), token);
    REQUIRE(answer);
    CHECK(is_reach_answer(text_of(*answer), nonce, key));
    // An answer is no question: two nodes never answer each other for ever.
    CHECK_FALSE(reach_answer(text_of(*answer), token));
  }
}

TEST_CASE("who does not know the site token is not answered", "[reach]") {
  const auto question =
      reach_question(make_reach_nonce(), reach_key("another"), 64);
  CHECK_FALSE(reach_answer(text_of(question), token));
  CHECK_FALSE(reach_answer("", token));
  CHECK_FALSE(reach_answer("ROSCELL?", token));
}

TEST_CASE("a node without a site token answers nobody", "[reach]") {
  const auto question = reach_question(make_reach_nonce(), reach_key(""), 64);
  CHECK_FALSE(reach_answer(text_of(question), ""));
}

TEST_CASE("an answer that was changed, or is to another question, is none",
          "[reach]") {
  const auto nonce = make_reach_nonce();
  const auto answer =
      reach_answer(text_of(reach_question(nonce, key, 0)), token);
  REQUIRE(answer);
  CHECK_FALSE(is_reach_answer(text_of(*answer), make_reach_nonce(), key));
  for (size_t i = 0; i < answer->size(); ++i) {
    auto changed = *answer;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    CHECK_FALSE(is_reach_answer(text_of(changed), nonce, key));
  }
}
