#pragma once

#include "messages/inside/introspection.hpp"
#include "messages/instance.hpp"
#include "messages/reservation.hpp"
#include "messages/session.hpp"

#include <string>
#include <vector>

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

/// What belongs to one instance on its host.
struct measured_instance {
  std::string instance;
  std::string container; ///< The runtime's id of it.

  static constexpr auto fields() {
    return field_list{required("instance", &measured_instance::instance),
                      required("container", &measured_instance::container)};
  }
};

/// Asks the probe what instances take of the host.
struct measure_use {
  std::vector<measured_instance> instances;

  static constexpr auto fields() {
    return field_list{required("instances", &measure_use::instances)};
  }
};

struct measured_use {
  std::string instance;
  instance_use use;

  static constexpr auto fields() {
    return field_list{required("instance", &measured_use::instance),
                      required("use", &measured_use::use)};
  }
};

struct use_measured {
  std::vector<measured_use> instances; ///< As far as anything is known.

  static constexpr auto fields() {
    return field_list{required("instances", &use_measured::instances)};
  }
};

/// Takes a CPU sample now, so that a later measurement need not wait for one.
/// Sent along with work that is done anyway, such as a heartbeat.
struct mark_sample {
  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
