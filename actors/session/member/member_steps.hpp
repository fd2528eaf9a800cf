#pragma once

#include "actors/session/member/member.hpp"

#include <cstdint>
#include <string>

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
