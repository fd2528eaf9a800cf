#include "roscell/ros2/stamp.hpp"

#include "roscell/ros2/detail/cdr_reader.hpp"

namespace roscell::ros2 {

using namespace std::chrono;
using builtin_interfaces::time;

time to_time(system_clock::time_point when) {
  auto whole = floor<seconds>(when);
  return {static_cast<std::int32_t>(whole.time_since_epoch().count()),
          static_cast<std::uint32_t>(nanoseconds{when - whole}.count())};
}

system_clock::time_point to_time_point(const time& stamp) {
  return system_clock::time_point{duration_cast<system_clock::duration>(
      seconds{stamp.sec} + nanoseconds{stamp.nanosec})};
}

std::optional<time> stamp_of(std::string_view payload) {
  try {
    time result;
    cdr_reader{payload}.read(result);
    return result;
  } catch (const cdr_error&) {
    return std::nullopt;
  }
}

} // namespace roscell::ros2
