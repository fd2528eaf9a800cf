#pragma once

#include "messages/instance.hpp"

#include <string>
#include <vector>

/// How a coordinator makes sure that a node has room for what it was allocated.
namespace roscell {

/// Coordinator to member: keep room for these until they are deployed. What is
/// not deployed or removed within a minute is given up. Repeating it renews it.
struct instance_reservation {
  static constexpr const char* type = "instance_reservation";
  std::string task;
  std::vector<instance_spec> specs;
  /// They were placed with the floored reading of the CPU, so the node reads
  /// its own in the same way.
  bool cpu_floor = false;

  static constexpr auto fields() {
    return field_list{required("task", &instance_reservation::task),
                      required("specs", &instance_reservation::specs),
                      optional("cpu_floor", &instance_reservation::cpu_floor)};
  }
};

/// An instance for which a node has no room.
struct refused_instance {
  std::string instance;
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("instance", &refused_instance::instance),
                      required("reason", &refused_instance::reason)};
  }
};

/// Reply to `instance_reservation`: there is room, but for those refused.
struct instances_reserved {
  static constexpr const char* type = "instances_reserved";
  std::vector<refused_instance> refused;

  static constexpr auto fields() {
    return field_list{required("refused", &instances_reserved::refused)};
  }
};

} // namespace roscell
