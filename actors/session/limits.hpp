#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Two ends of a session, and what is asked over it.
namespace roscell::limits {

/// Two ends of a session. The node gives up its own parts `margin` before the
/// coordinator gives up the node, so that the coordinator hears why.
namespace session {

constexpr milliseconds margin{2000};
/// For the owner of a session to take a frame.
constexpr seconds owner{30};
/// For a session to another coordinator, or of a node that joins.
constexpr seconds open{10};
/// Requests that wait for their replies. No peer needs more at once.
constexpr size_t pending_calls = 256;
/// Ids of requests that are known, so that one delivered twice is done once.
constexpr size_t known_calls = 256;
/// Heartbeats whose times are known until they are answered: more than a lease
/// has.
constexpr size_t remembered_heartbeats = 64;
/// Larger answers are not kept: who asks again is told to ask anew.
constexpr size_t kept_answer_bytes = 16 * kib;
/// A peer that sends more that cannot be read does not speak our language.
constexpr unsigned bad_frames = 3;
/// A measurement that has no CPU sample yet takes a second.
constexpr milliseconds resource_query{6000};
/// For what a node's instances say of themselves.
constexpr milliseconds metrics{4000};
/// For other parameters of an instance.
constexpr milliseconds parameters{9000};
/// One coordinator's word to another one.
constexpr milliseconds peer_answer{3000};

} // namespace session

namespace membership {

/// From the session's start to the registration.
constexpr milliseconds registration_arrival{15'000};
/// From the registration to its answer. Shorter than a lease: a registry must
/// not show for longer a member that does not know that it is one.
constexpr milliseconds registration{5000};
/// What the coordinator has for it, so that the node hears the outcome.
constexpr milliseconds row{4000};
/// For a place: the coordinator that hands them out may be another one, and a
/// third one has to keep it.
constexpr milliseconds place{8000};
/// For a switch to be written down.
constexpr milliseconds switching{6000};
/// How long a node that leaves waits for the coordinator to know.
constexpr milliseconds departure{2000};

} // namespace membership

namespace task {

/// The longest that a query may wait for a change of a task
/// (messages/task.hpp).
constexpr milliseconds change_wait{20'000};

} // namespace task

namespace history {

/// For a coordinator to have the list of all kept logs of its members: those
/// that are silent are left out.
constexpr seconds member_list{5};

} // namespace history

} // namespace roscell::limits
