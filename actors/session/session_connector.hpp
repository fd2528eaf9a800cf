#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/heartbeat_socket.hpp"
#include "actors/edge/session/site_token.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace roscell {

/// What sessions are made with. The edges outlive every actor.
struct connector_parts {
  io_thread* io = nullptr;
  heartbeat_socket* heartbeats = nullptr;
  site_secret site;
  site_keeper_actor keeper; ///< Hears of coordinators; invalid in tests.
};

/// Opens sessions to coordinators.
struct session_connector_state {
  static constexpr const char* name = "session-connector";

  actor_context context;
  connector_parts parts;
  uint64_t attempts = 0;
  std::map<uint64_t, caf::typed_response_promise<session_opened>> pending;
};

/// The SESSION CONNECTOR. Messages: messages/inside/link.hpp.
session_connector_actor::behavior_type session_connector(
    session_connector_actor::stateful_pointer<session_connector_state> self,
    const actor_context& context, const connector_parts& parts);

} // namespace roscell
