#pragma once

#include "actors/membership.hpp"

/// INTERNAL to the membership: the steps that its files share.
namespace roscell::membership_steps {

using self_pointer = membership_actor::stateful_pointer<membership_status>;

/// Sets the timer to whatever is due first.
void set_timer(self_pointer self);

/// Tells a fact about this node, with where it concerns.
void tell(self_pointer self, const char* what, json data);

// -- membership_attempt.cpp: from nothing to joined ---------------------------

void begin_attempt(self_pointer self);
void on_found(self_pointer self, const coordinator_found& found);
/// The time of `searching` is over.
void on_search_over(self_pointer self);
/// The attempt came to nothing; the next one follows after a pause.
void attempt_failed(self_pointer self, const std::string& reason);
/// The coordinator does not want this node; asked again, but slowly.
void attempt_refused(self_pointer self, const std::string& reason);

// -- membership_session.cpp: what comes and goes over the session -------------

/// Takes a session over.
void take_session(self_pointer self, const session_actor& session);
/// Closes the session if there is one; its pending calls fail.
void drop_session(self_pointer self, const std::string& reason);
/// Whether the present message comes from the present session.
bool is_from_session(self_pointer self);
void on_frame(self_pointer self, const frame_received& frame);
void on_beat(self_pointer self, const beat_received& beat);
void on_session_lost(self_pointer self, const std::string& reason);
/// Does what the lease wants.
void keep_lease(self_pointer self);
void notify(self_pointer self, const instance_changed& fact);

// -- membership_verdicts.cpp --------------------------------------------------

/// Stops and starts what the coordinator has decided on.
void apply(self_pointer self, const std::vector<instance_verdict>& verdicts);

// -- membership.cpp -----------------------------------------------------------

/// The last step of leaving.
void finish_leaving(self_pointer self);

} // namespace roscell::membership_steps
