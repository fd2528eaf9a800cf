#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/site/site_secret.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace roscell {

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
