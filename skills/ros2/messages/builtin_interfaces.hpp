#pragma once

#include "skills/ros2/messages/fields.hpp"

#include <chrono>
#include <cstdint>

namespace roscell::ros2 {

/// builtin_interfaces/msg/Time: since 1970-01-01 00:00 UTC.
struct time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  static constexpr auto fields() {
    return std::make_tuple(named("sec", &time::sec),
                           named("nanosec", &time::nanosec));
  }
};

/// Exact to the nanosecond until the year 2038.
time to_time(std::chrono::system_clock::time_point when);

std::chrono::system_clock::time_point to_time_point(const time& stamp);

} // namespace roscell::ros2
