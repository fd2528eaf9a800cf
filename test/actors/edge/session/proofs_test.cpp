#include "actors/edge/session/limits.hpp"
#include "actors/edge/session/proofs.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <vector>

namespace roscell {

namespace {

using namespace std::chrono_literals;

const std::string known_token = "site-token";

registration_order sample() {
  registration_order x;
  x.nonce = std::string(64, '0');
  x.node = "robot-1";
  x.uuid = "0a1b";
  x.epoch = 7;
  x.cell = "kitchen";
  x.coordinator = "ffff";
  x.discovery_server = "10.0.0.1:11811";
  x.address = "10.0.0.1:8420";
  x.transfer = "t-1";
  return x;
}

/// Any moment.
const registration_challenges::time_point start{100h};

} // namespace

TEST_CASE("who knows the site token can give an order, nobody else") {
  const auto proof = prove(sample(), known_token);
  CHECK(proof.size() == 64);
  CHECK(proves(sample(), known_token, proof));
  CHECK_FALSE(proves(sample(), "other", proof));
  CHECK_FALSE(proves(sample(), known_token, prove(sample(), "other")));
  for (const auto& damaged :
       {std::string{}, std::string(64, '0'), std::string(64, 'x'),
        proof.substr(0, 62), proof + "00", proof.substr(1)})
    CHECK_FALSE(proves(sample(), known_token, damaged));
}

TEST_CASE("under an empty token nothing is proven, whoever signs") {
  const status_claim claim{std::string(64, '0'), "robot-1", "0a1b", 7,
                           "independent"};
  const status_question question{std::string(64, '0')};
  CHECK_FALSE(proves(sample(), "", prove(sample(), "")));
  CHECK_FALSE(proves(claim, "", prove(claim, "")));
  CHECK_FALSE(proves(question, "", prove(question, "")));
}

TEST_CASE("a question is proven for its nonce only, and is no order") {
  const status_question question{std::string(64, '0')};
  const auto proof = prove(question, known_token);
  CHECK(proves(question, known_token, proof));
  CHECK_FALSE(proves(question, "other", proof));
  CHECK_FALSE(
      proves(status_question{std::string(64, '1')}, known_token, proof));
  CHECK_FALSE(proves(sample(), known_token, proof));
}

TEST_CASE("the proof of an order is the one that is written down") {
  // HMAC-SHA256 by Python's hmac over label and fields, each after its length
  // in four bytes, the highest first.
  CHECK(prove(sample(), known_token)
        == "60692c6d6725068df7aea8a1b85dfb131f2bd525be5bcbcf02f23b6c00f564a9");
}

TEST_CASE("every part of what a node says of its status is under its proof") {
  const status_claim claim{std::string(64, '0'), "robot-1", "0a1b", 7,
                           "independent"};
  const auto proof = prove(claim, known_token);
  CHECK(proves(claim, known_token, proof));
  CHECK_FALSE(proves(claim, "other", proof));
  CHECK_FALSE(proves(claim, known_token, ""));
  for (auto part : {&status_claim::nonce, &status_claim::node,
                    &status_claim::uuid, &status_claim::state}) {
    auto x = claim;
    (x.*part).back() ^= 1;
    CHECK_FALSE(proves(x, known_token, proof));
  }
  auto older = claim;
  older.epoch = 6;
  CHECK_FALSE(proves(older, known_token, proof));
  // It is worth nothing as an order, nor the other way round.
  CHECK_FALSE(proves(sample(), known_token, proof));
  CHECK_FALSE(proves(claim, known_token, prove(sample(), known_token)));
}

TEST_CASE("every part of an order is under its proof") {
  const auto proof = prove(sample(), known_token);
  for (auto part :
       {&registration_order::nonce, &registration_order::node,
        &registration_order::uuid, &registration_order::cell,
        &registration_order::coordinator, &registration_order::discovery_server,
        &registration_order::address, &registration_order::transfer}) {
    auto x = sample();
    (x.*part).back() ^= 1;
    CHECK_FALSE(proves(x, known_token, proof));
  }
  auto older = sample();
  older.epoch = 6;
  CHECK_FALSE(proves(older, known_token, proof));
  // The border between two parts counts.
  auto shifted = sample();
  shifted.node = "robot-";
  shifted.uuid = "10a1b";
  CHECK_FALSE(proves(shifted, known_token, proof));
}

TEST_CASE("a nonce is good for one switch") {
  registration_challenges x;
  const auto nonce = x.issue(start);
  CHECK(nonce.size() == 64);
  CHECK_FALSE(x.is_fresh("", start));
  CHECK_FALSE(x.is_fresh(std::string(64, '0'), start));
  CHECK_FALSE(x.is_fresh(std::string(64, 'x'), start));
  CHECK(x.is_fresh(nonce, start));
  x.spend(nonce, start);
  CHECK_FALSE(x.is_fresh(nonce, start));
}

TEST_CASE("a nonce is good for its lifetime only") {
  registration_challenges x;
  const auto first = x.issue(start);
  const auto third = x.issue(start + 2s);
  const auto end = start + limits::token::nonce_lifetime;
  CHECK(x.is_fresh(first, end - 1ns));
  CHECK_FALSE(x.is_fresh(first, end));
  CHECK(x.is_fresh(third, end + 2s - 1ns));
  // Nobody can make an old one young.
  CHECK_FALSE(x.is_fresh(third.substr(0, 32) + first.substr(32), end));
}

TEST_CASE("another node's nonce is none") {
  const registration_challenges x;
  registration_challenges y;
  CHECK_FALSE(y.is_fresh(x.issue(start), start));
}

TEST_CASE(
    "unauthenticated peers who ask for nonces make no other one worthless") {
  registration_challenges x;
  const auto honest = x.issue(start);
  std::set<std::string> nonces;
  for (int i = 0; i < 1000; ++i)
    nonces.insert(x.issue(start));
  CHECK(nonces.size() == 1000);
  CHECK(x.is_fresh(honest, start + 1s));
}

TEST_CASE("spent nonces are forgotten when they are too old anyway") {
  registration_challenges x;
  auto now = start;
  for (size_t i = 0; i < limits::token::spent_nonces; ++i) {
    const auto nonce = x.issue(now);
    REQUIRE(x.is_fresh(nonce, now));
    x.spend(nonce, now);
  }
  CHECK_FALSE(x.is_fresh(x.issue(now), now));
  now += limits::token::nonce_lifetime;
  CHECK(x.is_fresh(x.issue(now), now));
}

} // namespace roscell
