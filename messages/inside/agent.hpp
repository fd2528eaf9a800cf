#pragma once

#include "messages/inside/introspection.hpp"
#include "messages/reservation.hpp"
#include "messages/session.hpp"

namespace roscell {

/// Asks the probe for what the host has and what programs outside our
/// instances use of it.
struct measure_host {
  std::vector<int64_t> sessions;       ///< Session leaders of our instances.
  std::vector<std::string> containers; ///< An engine's ids of the others.

  static constexpr auto fields() {
    return field_list{required("sessions", &measure_host::sessions),
                      required("containers", &measure_host::containers)};
  }
};

struct host_measured {
  node_resources resources; ///< `used` leaves our instances out.

  static constexpr auto fields() {
    return field_list{required("resources", &host_measured::resources)};
  }
};

/// Takes a CPU sample now, so that a later measurement need not wait for one.
/// Sent along with work that is done anyway, such as a beat.
struct mark_sample {
  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
