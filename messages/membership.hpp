#pragma once

#include "messages/agent.hpp"
#include "messages/link.hpp"
#include "messages/runtime.hpp"

#include <string>

namespace roscell {

/// Asks where the node stands.
struct membership_query {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

struct membership_state {
  node_identity identity;
  node_state state = node_state::independent;
  std::string cell;
  std::string coordinator; ///< Address of the coordinator's HTTP port.

  static constexpr auto fields() {
    return std::make_tuple(
        required("identity", &membership_state::identity),
        required("state", &membership_state::state),
        required("cell", &membership_state::cell),
        required("coordinator", &membership_state::coordinator));
  }
};

/// Joins the cell of a given discovery server, now and after every loss.
struct join_cell {
  std::string discovery_server; ///< "ip:port"

  static constexpr auto fields() {
    return std::make_tuple(
        required("discovery_server", &join_cell::discovery_server));
  }
};

/// Asks the coordinators that are visible for a place, now and whenever one
/// appears, until the node is in a cell.
struct seek_cell {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// What of a node's belonging outlives its process.
struct membership_record {
  /// How the node was started: the address given, "wait" or nothing. A node
  /// that is started in another way forgets the rest.
  std::string configured;
  std::string discovery_server; ///< Of its cell; empty: it was released.
  std::string cell;
  join_origin origin = join_origin::given;

  static constexpr auto fields() {
    return std::make_tuple(
        required("configured", &membership_record::configured),
        required("discovery_server", &membership_record::discovery_server),
        required("cell", &membership_record::cell),
        required("origin", &membership_record::origin));
  }
};

/// Leaves in order, telling the coordinator.
struct leave_cell {
  std::string reason;

  static constexpr auto fields() {
    return std::make_tuple(required("reason", &leave_cell::reason));
  }
};

/// The MEMBERSHIP: the node's side of belonging to a cell.
using membership_actor = introspected_actor::extend<
    caf::replies_to<membership_query>::with<membership_state>,
    caf::reacts_to<join_cell>, caf::reacts_to<seek_cell>,
    // Gives out a nonce for a switch.
    caf::replies_to<registration_query>::with<registration_challenge>,
    // From the REST API. Errors: unauthorized (a wrong proof, or a member's
    // registration, which only its coordinator can switch), conflict (another
    // epoch than the present one, or it is switching already).
    caf::replies_to<registration_switch>::with<switch_accepted>,
    // Replies once the coordinator knows, or after a short wait.
    caf::replies_to<leave_cell>::with<node_departed>,
    caf::reacts_to<coordinator_found>, caf::reacts_to<presence_seen>,
    caf::reacts_to<presence_gone>, caf::reacts_to<instance_changed>,
    caf::reacts_to<frame_received>, caf::reacts_to<beat_received>,
    caf::reacts_to<session_closed>,
    // INTERNAL: a timer of attempt or lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The MEMBER: the coordinator's view of one remote node. A node agent that
/// speaks over a session, and the lease of that session. It ends with it.
using member_actor = node_agent_actor::extend<
    // Errors: those of the node; unreachable and timeout leave it open whether
    // the node has gone.
    caf::replies_to<registration_switch>::with<switch_accepted>,
    caf::reacts_to<frame_received>, caf::reacts_to<beat_received>,
    caf::reacts_to<session_closed>,
    // Ends the session, telling the node why.
    caf::reacts_to<close_session>,
    // INTERNAL: a timer of lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The PEER: a coordinator's view of another one. The questions are those that
/// a coordinator answers itself; it asks them over the session. It ends with
/// the session, telling the coordinator `peer_lost`.
using peer_actor = introspected_actor::extend<
    // Errors: those of the other coordinator; unreachable, timeout.
    caf::replies_to<place_request>::with<place_granted>,
    caf::replies_to<place_reservation>::with<place_reserved>,
    caf::replies_to<member_surrender>::with<members_surrendered>,
    caf::replies_to<node_transfer>::with<node_transferred>,
    caf::replies_to<node_release>::with<node_released>,
    // To be told to the other coordinator; the standing comes first.
    caf::reacts_to<cell_standing>, caf::reacts_to<cell_changed>,
    caf::reacts_to<frame_received>, caf::reacts_to<beat_received>,
    caf::reacts_to<session_closed>,
    // Ends the session, telling the other coordinator why.
    caf::reacts_to<close_session>,
    // INTERNAL: a timer of lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

} // namespace roscell
