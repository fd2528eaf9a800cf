#pragma once

#include "actors/membership/membership.hpp"
#include "messages/event_kinds.hpp"

#include <caf/error.hpp>
#include <caf/expected.hpp>

#include <chrono>
#include <functional>
#include <map>
#include <string>

/// INTERNAL to the membership: the steps that its files share.
namespace roscell::membership_steps {

using self_pointer = membership_actor::stateful_pointer<membership_status>;

/// Sets the timer to whatever is due first.
void set_timer(self_pointer self);

/// Tells an event about this node, with where it concerns.
void publish_event(self_pointer self, const event_kind& what, json data);

// -- membership_attempt.cpp: from nothing to joined ---------------------------

void begin_attempt(self_pointer self);
void on_found(self_pointer self, const coordinator_found& found);
/// The time of `searching` is over.
void on_search_over(self_pointer self);
/// The attempt came to nothing; the next one follows after a pause.
void attempt_failed(self_pointer self, const std::string& reason,
                    const std::string& hint = {});
/// The coordinator does not want this node; asked again, but slowly.
void attempt_refused(self_pointer self, const std::string& reason,
                     const std::string& hint = {});
/// What is to be done once the time of `waiting` is over.
void try_again(self_pointer self);
/// The present attempt is over; the next one follows after `pause`.
void retreat(self_pointer self, const std::string& reason,
             std::chrono::milliseconds pause);
/// What to do when a request of the present attempt has failed.
void on_error(self_pointer self, const caf::error& why);
bool is_current(self_pointer self, uint64_t attempt, membership_phase where);
/// Leaves what identifies an instance and how it is. The coordinator knows the
/// rest; hundreds of whole rows would not fit into one frame.
void shorten(instance_row& row);

// -- membership_diagnosis.cpp: why nobody answers -----------------------------

/// Has the discovery server looked for whose address, or name, is wanted.
void find_server(self_pointer self);
/// Whether what is tried is to be looked at when there has been no answer.
bool is_looking(const membership_status& st);
/// There has been no answer for some time: finds out why, and tells it.
void seek_coordinators(self_pointer self);
/// Tells why the node is in no cell, unless that has just been told.
void complain(self_pointer self, const std::string& problem,
              const std::string& hint);

// -- membership_forwarding.cpp: what only a coordinator can answer ------------

/// Has the coordinator answer a request of this node's user.
caf::result<image_offered> ask_for_image(self_pointer self,
                                         image_request request);
caf::result<request_routed> pass_on(self_pointer self,
                                    const route_request& request);

// -- membership_slots.cpp: being seen, seeing others, asking for a slot -------

/// Announces the node as independent or orphaned.
void show_presence(self_pointer self);
void withdraw_presence_now(self_pointer self);
/// Looks around for a later life of a coordinator that has been silent for
/// longer than lost heartbeats explain.
void seek_coordinator(self_pointer self);
void on_presence_seen(self_pointer self, const node_presence& who);
void on_presence_gone(self_pointer self, const node_presence& who);
/// Looks for a slot, or waits until a coordinator appears.
void seek_slot(self_pointer self);
/// The slot that the node asked for came to nothing.
void forget_slot(self_pointer self);
/// An attempt of an orphan came to nothing: where it is announced and where it
/// was take turns, and who has refused it has no other. Whether the next one is
/// elsewhere.
bool turn_elsewhere(self_pointer self, bool refused);

// -- membership_switch.cpp: from one registration to another ------------------

/// Called once: when the node has said that it goes, or with why it does not.
using switch_reply = std::function<void(caf::expected<switch_accepted>)>;

/// For whoever proves to be of the site.
caf::result<registration_challenge>
make_challenge(self_pointer self, const registration_query& query);
/// By the REST API, where it has to be proven.
void on_proven_switch(self_pointer self, const registration_switch& order,
                      switch_reply reply);
/// By the session of the present coordinator.
void on_coordinators_switch(self_pointer self, const registration_switch& order,
                            switch_reply reply);
/// Goes back to what was before the switch; false if there is none.
bool give_up_switch(self_pointer self, const std::string& reason);
/// Writes down where the node belongs now, if that has changed.
void store_membership(self_pointer self);

// -- membership_session.cpp: what comes and goes over the session -------------

/// Takes a session over.
void take_session(self_pointer self, const session_actor& session);
/// Closes the session if there is one; its pending calls fail.
void drop_session(self_pointer self, const std::string& reason);
void on_frame(self_pointer self, const frame_received& frame);
void on_heartbeat(self_pointer self, const heartbeat_received& heartbeat);
void on_session_lost(self_pointer self, const std::string& reason);
/// Tells the coordinator, less of it where the whole does not fit into a frame.
void notify(self_pointer self, const instance_changed& event);

/// Tells the coordinator which skills the node has by now.
void notify_skills(self_pointer self);

// -- program_servers.cpp: the node's own discovery server ---------------------

/// To be called at the start and after each registration, also where there is
/// nothing: what was interrupted, and what was started at another address,
/// waits for it. Instances that run have the environment that they were started
/// with: it names the server, whose id and port stay the same in a cell.
void publish_environment(self_pointer self);

/// Runs it where the cell wants it, from now on.
void serve_programs_of(self_pointer self, const node_registered& reply);
/// Takes up the one that an earlier run of the node had.
void resume_programs(self_pointer self);
/// Nothing is sent to the coordinator's server until it has registered again.
void let_remote_rest(self_pointer self);
/// The node is in no cell any more.
void stop_programs(self_pointer self);
/// UDP port of the one that runs; 0: none does.
uint16_t program_port(const membership_status& st);
/// What a ROS 2 program on this node needs; empty: it is in no cell.
std::map<std::string, std::string>
program_environment(const membership_status& st);

// -- membership_session.cpp: verdicts of the coordinator on instances ---------

/// Stops and starts what the coordinator has decided on.
void apply(self_pointer self, const std::vector<instance_verdict>& verdicts);

// -- membership.cpp -----------------------------------------------------------

/// The last step of leaving.
void finish_leaving(self_pointer self);

} // namespace roscell::membership_steps
