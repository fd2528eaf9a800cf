#pragma once

#include "roscell/ros2/builtin_interfaces.hpp"

#include <chrono>
#include <optional>
#include <string_view>

namespace roscell::ros2 {

/// A time of the system's clock as ROS 2 writes it. Exact to the nanosecond
/// until the year 2038.
builtin_interfaces::time to_time(std::chrono::system_clock::time_point when);

std::chrono::system_clock::time_point
to_time_point(const builtin_interfaces::time& stamp);

/// The stamp of a message that begins with a Header; none if it has none.
std::optional<builtin_interfaces::time> stamp_of(std::string_view payload);

} // namespace roscell::ros2
