#pragma once

#include "messages/introspection.hpp"
#include "messages/reservation.hpp"
#include "messages/session.hpp"

namespace roscell {

/// The NODE AGENT: what a coordinator may ask of a node. The local node, a
/// member behind a session and a test's fake all have this handle.
using node_agent_actor = introspected_actor::extend<
    // Errors: timeout, unreachable.
    caf::replies_to<resource_query>::with<resource_report>,
    // Errors: timeout, unreachable. A refusal is no error.
    caf::replies_to<instance_reservation>::with<instances_reserved>,
    // Replies once the instance runs. Errors: as the CONTAINER SUPERVISOR's.
    caf::replies_to<instance_deployment>::with<instance_deployed>,
    // Replies once the named instances are gone from the node.
    caf::replies_to<instance_removal>::with<instances_removed>,
    // Errors: unknown_task.
    caf::replies_to<log_query>::with<log_excerpt>>;

/// Asks the probe for what the host has and what programs outside our
/// instances use of it.
struct measure_host {
  std::vector<int64_t> sessions; ///< Session leaders of our instances.

  static constexpr auto fields() {
    return std::make_tuple(required("sessions", &measure_host::sessions));
  }
};

struct host_measured {
  node_resources resources; ///< `used` leaves our instances out.

  static constexpr auto fields() {
    return std::make_tuple(required("resources", &host_measured::resources));
  }
};

/// Takes a CPU sample now, so that a later measurement need not wait for one.
/// Sent along with work that is done anyway, such as a beat.
struct mark_sample {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// The RESOURCE PROBE: answers when asked, at once; it never polls.
using resource_probe_actor = introspected_actor::extend<
    caf::replies_to<measure_host>::with<host_measured>,
    caf::reacts_to<mark_sample>>;

} // namespace roscell
