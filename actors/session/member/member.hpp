#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/session/held_session.hpp"
#include "messages/messages.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace roscell {

/// Where a member's session stands; the diagram is in docs/protocols.md.
enum class member_phase { awaiting, registering, active, departing, departed };

constexpr auto enum_words(member_phase) {
  return std::array<std::string_view, 5>{"awaiting", "registering", "active",
                                         "departing", "departed"};
}

/// Owns one node's session, as its coordinator sees it.
struct member_state : held_session {
  static constexpr const char* name = "member";

  node_identity peer; ///< As the handshake has proved it.
  cell_coordinator_actor coordinator;

  member_phase phase = member_phase::awaiting;
  alarm timer;
  std::chrono::steady_clock::time_point registration_deadline;
  bool announced = false; ///< The coordinator has been told of this member.
  bool ended = false;
};

/// The MEMBER. Messages: messages/inside/membership.hpp. It takes the session
/// over at once and ends with it, telling the coordinator `member_lost` unless
/// the node has departed. Its death closes the session too.
member_actor::behavior_type
member(member_actor::stateful_pointer<member_state> self,
       session_admitted accepted, cell_coordinator_actor coordinator);

} // namespace roscell

/// INTERNAL to the member: the steps that its files share.
namespace roscell::member_steps {

using self_pointer = member_actor::stateful_pointer<member_state>;

/// Sets the timer to whatever is due first.
void set_timer(self_pointer self);

/// Closes the session and ends the actor.
void end_member(self_pointer self, const std::string& reason);

// -- member_requests.cpp: what the node asks and tells
// -------------------------

void on_request(self_pointer self, uint64_t id, const session_inquiry& x);
void on_notice(self_pointer self, const json& body);

} // namespace roscell::member_steps
