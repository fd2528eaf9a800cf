#include "actors/edge/session/registration_proof.hpp"
#include "actors/house/limits.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <vector>

namespace roscell {

namespace {

using namespace std::chrono_literals;

const std::string token = "site-token";

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
  const auto proof = prove(sample(), token);
  CHECK(proof.size() == 64);
  CHECK(proves(sample(), token, proof));
  CHECK_FALSE(proves(sample(), "other", proof));
  CHECK_FALSE(proves(sample(), token, prove(sample(), "other")));
  for (const auto& damaged :
       {std::string{}, std::string(64, '0'), std::string(64, 'x'),
        proof.substr(0, 62), proof + "00", proof.substr(1)})
    CHECK_FALSE(proves(sample(), token, damaged));
}

TEST_CASE("the proof of an order is the one that is written down") {
  // HMAC-SHA256 by Python's hmac over label and fields, each after its length
  // in four bytes, the highest first.
  CHECK(prove(sample(), token)
        == "60692c6d6725068df7aea8a1b85dfb131f2bd525be5bcbcf02f23b6c00f564a9");
}

TEST_CASE("every part of what a node says of its standing is under its proof") {
  const standing_claim claim{std::string(64, '0'), "robot-1", "0a1b", 7,
                             "independent"};
  const auto proof = prove(claim, token);
  CHECK(proves(claim, token, proof));
  CHECK_FALSE(proves(claim, "other", proof));
  CHECK_FALSE(proves(claim, token, ""));
  for (auto part : {&standing_claim::nonce, &standing_claim::node,
                    &standing_claim::uuid, &standing_claim::state}) {
    auto x = claim;
    (x.*part).back() ^= 1;
    CHECK_FALSE(proves(x, token, proof));
  }
  auto older = claim;
  older.epoch = 6;
  CHECK_FALSE(proves(older, token, proof));
  // It is worth nothing as an order, nor the other way round.
  CHECK_FALSE(proves(sample(), token, proof));
  CHECK_FALSE(proves(claim, token, prove(sample(), token)));
}

TEST_CASE("every part of an order is under its proof") {
  const auto proof = prove(sample(), token);
  for (auto part :
       {&registration_order::nonce, &registration_order::node,
        &registration_order::uuid, &registration_order::cell,
        &registration_order::coordinator, &registration_order::discovery_server,
        &registration_order::address, &registration_order::transfer}) {
    auto x = sample();
    (x.*part).back() ^= 1;
    CHECK_FALSE(proves(x, token, proof));
  }
  auto older = sample();
  older.epoch = 6;
  CHECK_FALSE(proves(older, token, proof));
  // The border between two parts counts.
  auto shifted = sample();
  shifted.node = "robot-";
  shifted.uuid = "10a1b";
  CHECK_FALSE(proves(shifted, token, proof));
}

TEST_CASE("a nonce can be redeemed once") {
  registration_challenges x;
  const auto nonce = x.issue(start);
  CHECK(nonce.size() == 64);
  CHECK_FALSE(x.redeem("", start));
  CHECK_FALSE(x.redeem(std::string(64, '0'), start));
  CHECK(x.redeem(nonce, start));
  CHECK_FALSE(x.redeem(nonce, start));
}

TEST_CASE("a nonce is good for its lifetime only") {
  registration_challenges x;
  const auto first = x.issue(start);
  const auto second = x.issue(start + 1s);
  const auto third = x.issue(start + 2s);
  const auto end = start + limits::token::nonce_lifetime;
  CHECK(x.redeem(second, end));
  CHECK_FALSE(x.redeem(first, end));
  CHECK(x.redeem(third, end + 2s - 1ns));
  const auto fourth = x.issue(end);
  CHECK_FALSE(x.redeem(fourth, end + limits::token::nonce_lifetime));
}

TEST_CASE("when too many nonces are out, the oldest goes") {
  registration_challenges x;
  std::vector<std::string> nonces;
  for (size_t i = 0; i <= limits::token::outstanding_nonces; ++i)
    nonces.push_back(x.issue(start));
  CHECK(std::set<std::string>{nonces.begin(), nonces.end()}.size()
        == nonces.size());
  CHECK_FALSE(x.redeem(nonces.front(), start));
  for (size_t i = 1; i < nonces.size(); ++i)
    CHECK(x.redeem(nonces[i], start));
}

} // namespace roscell
