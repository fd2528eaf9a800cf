#include "actors/edge/session/registration_proof.hpp"

#include "actors/edge/session/session_handshake.hpp"
#include "actors/edge/session/transcript.hpp"
#include "actors/house/limits.hpp"

#include <algorithm>

namespace roscell {

namespace {

constexpr std::string_view label = "roscell registration v1";

digest sign(const registration_order& order, std::string_view site_token) {
  return transcript{label}
      .add(order.nonce)
      .add(order.node)
      .add(order.uuid)
      .add(order.epoch)
      .add(order.cell)
      .add(order.coordinator)
      .add(order.discovery_server)
      .add(order.address)
      .add(order.transfer)
      .sign(site_token);
}

constexpr std::string_view standing_label = "roscell standing v1";

digest sign(const standing_claim& claim, std::string_view site_token) {
  return transcript{standing_label}
      .add(claim.nonce)
      .add(claim.node)
      .add(claim.uuid)
      .add(claim.epoch)
      .add(claim.state)
      .sign(site_token);
}

} // namespace

std::string prove(const registration_order& order,
                  std::string_view site_token) {
  return to_hex(sign(order, site_token));
}

bool proves(const registration_order& order, std::string_view site_token,
            std::string_view proof) {
  return is_proof(proof, sign(order, site_token));
}

std::string prove(const standing_claim& claim, std::string_view site_token) {
  return to_hex(sign(claim, site_token));
}

bool proves(const standing_claim& claim, std::string_view site_token,
            std::string_view proof) {
  return is_proof(proof, sign(claim, site_token));
}

std::string registration_challenges::issue(time_point now) {
  if (outstanding_.size() == limits::token::outstanding_nonces)
    outstanding_.pop_front();
  outstanding_.push_back({make_nonce(), now + limits::token::nonce_lifetime});
  return outstanding_.back().nonce;
}

bool registration_challenges::redeem(std::string_view nonce, time_point now) {
  while (!outstanding_.empty() && outstanding_.front().end <= now)
    outstanding_.pop_front();
  const auto i =
      std::find_if(outstanding_.begin(), outstanding_.end(),
                   [&](const challenge& x) { return x.nonce == nonce; });
  if (i == outstanding_.end())
    return false;
  outstanding_.erase(i);
  return true;
}

} // namespace roscell
