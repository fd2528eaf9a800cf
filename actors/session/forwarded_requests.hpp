#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace roscell {

/// How long the two ends of a session wait for a request that a member passes
/// on to its coordinator.
struct forwarding_limits {
  std::chrono::milliseconds coordinator; ///< For what answers it there.
  std::chrono::milliseconds member;      ///< For the coordinator, longer.
};

/// The limits of a type that members pass on; none if that type is not passed
/// on. What takes nodes out of cells is not: the session that would bring the
/// answer may end by it.
std::optional<forwarding_limits> forwarding_of(const std::string& type);

} // namespace roscell
