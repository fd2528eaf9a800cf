#pragma once

#include "actors/edge/session/registration_proof.hpp"
#include "messages/peer.hpp"

namespace roscell {

/// What a switch is proven with.
inline registration_order order_of(const registration_switch& x) {
  registration_order result;
  result.nonce = x.nonce;
  result.node = x.node;
  result.uuid = x.uuid;
  result.epoch = x.epoch;
  result.transfer = x.transfer;
  if (!x.target.empty()) {
    const auto& to = x.target.front();
    result.cell = to.cell;
    result.coordinator = to.coordinator;
    result.discovery_server = to.discovery_server;
    result.address = to.address;
  }
  return result;
}

} // namespace roscell
