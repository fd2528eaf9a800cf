#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// What a coordinator holds and waits for: nodes, cells, tasks, transfers.
namespace roscell::limits {

namespace store {

/// For one record of the coordinator in its database. What waits for it has
/// `local::answer`.
constexpr seconds write{5};

} // namespace store

namespace resource {

/// What a coordinator waits for its members' metrics: those that come later
/// are missing, since one silent node must not hold up a task.
constexpr seconds collection{3};
/// How often a node is asked in one such collection, at most.
constexpr int rounds = 3;

} // namespace resource

namespace instance {

/// Rows that a coordinator remembers of what one node has told.
constexpr size_t reported = 1024;

} // namespace instance

namespace membership {

/// How long a name stays with a node that is expected back: longer than the
/// pause between two of its attempts and the attempt itself.
constexpr milliseconds expected_name_held{45'000};

} // namespace membership

/// What anybody may announce on the public domain. Nobody who has not proved
/// that he is of the site costs more than this.
namespace unauthenticated_peers {

/// Coordinators that a coordinator remembers.
constexpr size_t coordinators = 256;

/// Nodes in no cell that are remembered.
constexpr size_t unassigned_nodes = 1024;
/// Of those that announce themselves no more, the last ones.
constexpr size_t silent_nodes = 64;

/// Connections that are being opened at a time: to coordinators, and to nodes
/// that are to prove where they stand.
constexpr size_t peer_calls = 6;
constexpr size_t proof_calls = 2;

/// One that failed keeps its slot this long, so that ever new addresses cost no
/// more than the slots in that time.
constexpr seconds slot_pause{1};

/// A nonce goes there, a proof comes back.
constexpr seconds proof{8};

} // namespace unauthenticated_peers

/// How cells form and are balanced.
namespace cell {

/// Time for a place's node to come: it has to find the server and open a
/// session.
constexpr seconds place{30};
/// For a node's answer to a registration switch, for which its client has
/// `registration_call`.
constexpr seconds invitation{12};
/// For a node that said yes to arrive.
constexpr seconds arrival{25};
/// For a place that waits for an invited node.
constexpr seconds invited_place{40};

/// Until a coordinator that has just appeared has told its size; a node that
/// asks for a slot waits no longer for it.
constexpr milliseconds sizes{1500};
/// Places in other cells that are remembered, and those who wait for a node or
/// for the sizes.
constexpr size_t places = 4096;
constexpr size_t waiting = 1024;
/// After a change of the coordinators' sizes, until they are balanced.
constexpr seconds settling{2};

} // namespace cell

namespace task {

/// How long a moved instance is to be healthy before the next one is moved.
constexpr seconds healthy_for{10};

/// For a node to have an instance work with other parameters: the end of its
/// session waits for `session::parameters`.
constexpr seconds agent_parameters{11};

/// Events that are kept of a task: its first ones and the newest; and for how
/// many tasks, those that are gone too.
constexpr size_t first_events = 50;
constexpr size_t newest_events = 150;
constexpr size_t histories = 128;
/// Most of each text in such an event.
constexpr size_t event_text_bytes = 512;

/// A termination whose record cannot be removed for so long is answered with
/// the problem; the removal goes on.
constexpr seconds unwritten{15};

/// Claims that wait for the placement lock, and repetitions of one request that
/// wait for its first reply.
constexpr size_t waiting = 256;
constexpr size_t same_requests = 64;

/// Requests that a task has had before and that are kept, to go back to: so
/// many, and no more bytes than that.
constexpr size_t former_requests = 4;
constexpr size_t former_request_bytes = 64 * 1024;

/// Tasks at a time, whatever their state.
constexpr size_t most = 1000;

/// Sets of tasks, and how many of a set's tasks something is done for at a
/// time: less than what may wait for the placement lock.
constexpr size_t sets = 64;
constexpr size_t set_work = 32;

/// Tasks whose steps have all ended that are kept; the oldest go.
constexpr size_t settled = 100;

/// Terminated tasks that are remembered, to answer a repeated termination.
constexpr size_t terminated = 100;

/// Instances of all nodes of which it is known that they may run. Beyond it
/// nothing more is started.
constexpr size_t places = 16'384;
/// What was told to end when the coordinator was started again is started anew
/// where it fits; nodes that were away with it come back meanwhile.
constexpr minutes return_of_nodes{2};

/// Instances of all nodes that were not removed in time and are asked for
/// again; beyond it a node hears of it at its next registration.
constexpr size_t overdue_removals = 1000;

} // namespace task

namespace build {

/// Builds that are the cell's.
constexpr size_t of_cell = 1000;
/// Builds that were removed, of which nodes that are away may have copies.
constexpr size_t remains = 1000;
/// Nodes that are asked one after the other to hold the second copy.
constexpr size_t keepers_tried = 5;

} // namespace build

/// Moving a node from one cell to another.
namespace transfer {

/// For a node that has left to be seen in its new cell.
constexpr seconds arrival{25};
/// How long the other coordinator keeps a place for it.
constexpr minutes place{2};
/// Ended ones that are remembered.
constexpr size_t ended = 100;

} // namespace transfer

namespace history {

/// For the lists of all members.
constexpr seconds cell_list{7};

} // namespace history

} // namespace roscell::limits
