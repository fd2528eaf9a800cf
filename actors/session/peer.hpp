#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/session/held_session.hpp"
#include "messages/messages.hpp"

#include <string>

namespace roscell {

struct peer_setup {
  session_actor session;
  std::string uuid; ///< Of the other coordination node, as proven.
  bool opened_here =
      true; ///< Then this side sends heartbeats, as a member does.
  cell_coordinator_actor coordinator; ///< The own one.
};

/// Owns one session with another coordinator.
struct peer_state : held_session {
  static constexpr const char* name = "peer";

  peer_setup setup;
  std::string cell; ///< The other one's, once it has told.
  alarm timer;
  bool ended = false;
};

/// The PEER. Messages: messages/inside/membership.hpp. It takes the session
/// over at once, tells the coordinator `peer_opened`, and passes on what comes
/// from the other side: notices as `peer_status_reported` and `peer_changed`,
/// questions as the questions they are. It ends with the session.
peer_actor::behavior_type peer(peer_actor::stateful_pointer<peer_state> self,
                               const peer_setup& setup);

} // namespace roscell
