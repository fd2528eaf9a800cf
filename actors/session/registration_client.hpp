#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/proofs.hpp"
#include "actors/edge/session/site_token.hpp"
#include "messages/messages.hpp"
#include "messages/peer.hpp"
#include "schemas/document.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

/// What a node has answered at its REST address, or why that is no answer. The
/// address was announced by whoever likes to, so that the text may be anything.
/// Errors: unreachable for what no node of ROSCell says, and the node's own.
std::variant<json, failure> read_answer(const std::string& text);

/// The same as a `Reply`.
template <class Reply>
std::variant<Reply, failure> answer_as(const std::string& text) {
  auto document = read_answer(text);
  if (auto* why = std::get_if<failure>(&document))
    return std::move(*why);
  return decode<Reply>(std::get<json>(document));
}

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

struct registration_client_config {
  io_thread* io = nullptr;
  site_secret site;
};

/// A node that is being told to switch.
struct registration_call {
  switch_node request;
  std::string nonce;   ///< Over which the node proves where it stands.
  bool proven = false; ///< The switch has been sent; else the nonce is awaited.
  caf::typed_response_promise<switch_accepted> promise;
};

/// A node that is being asked to prove where it stands.
struct status_call {
  prove_status request;
  std::string nonce;
  caf::typed_response_promise<status_proved> promise;
};

struct registration_client_state {
  static constexpr const char* name = "registration-client";

  registration_client_config config;
  uint64_t last_call = 0;
  std::map<uint64_t, registration_call> calls;
  std::map<uint64_t, status_call> questions; ///< Numbered like the calls.
};

/// The REGISTRATION CLIENT. Messages: messages/peer.hpp. It asks a node for a
/// nonce and sends it the switch with a proof, or has it prove its status.
registration_client_actor::behavior_type registration_client(
    registration_client_actor::stateful_pointer<registration_client_state> self,
    const registration_client_config& config);

} // namespace roscell
