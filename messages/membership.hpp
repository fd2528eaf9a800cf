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
    caf::reacts_to<join_cell>,
    // Replies once the coordinator knows, or after a short wait.
    caf::replies_to<leave_cell>::with<node_departed>,
    caf::reacts_to<coordinator_found>, caf::reacts_to<instance_changed>,
    caf::reacts_to<frame_received>, caf::reacts_to<beat_received>,
    caf::reacts_to<session_closed>,
    // INTERNAL: a timer of attempt or lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The MEMBER: the coordinator's view of one remote node. A node agent that
/// speaks over a session, and the lease of that session. It ends with it.
using member_actor =
    node_agent_actor::extend<caf::reacts_to<frame_received>,
                             caf::reacts_to<beat_received>,
                             caf::reacts_to<session_closed>,
                             // Ends the session, telling the node why.
                             caf::reacts_to<close_session>,
                             // INTERNAL: a timer of lease number N.
                             caf::reacts_to<caf::tick_atom, uint64_t>>;

} // namespace roscell
