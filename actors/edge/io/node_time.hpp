#pragma once

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>

/// The time by which a node notes when something has happened. A wall clock may
/// be set at any moment: a host without a battery begins in 1970, and is right
/// once its network is there. Ages would be absurd from then on, so this time
/// begins as the wall clock says when the process begins, and goes on as the
/// clock since boot does, which nobody sets.
namespace roscell {

inline int64_t clock_ms(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

/// When this process noted something for the first time.
struct node_time_start {
  int64_t unix_ms = clock_ms(CLOCK_REALTIME);
  int64_t boot_ms = clock_ms(CLOCK_BOOTTIME);
};

inline const node_time_start& start_of_node_time() {
  static const node_time_start result;
  return result;
}

/// Milliseconds since 1970.
inline int64_t node_time_ms() {
  const auto& start = start_of_node_time();
  return start.unix_ms + clock_ms(CLOCK_BOOTTIME) - start.boot_ms;
}

/// How far the wall clock has been set ahead of it. The same until it is set
/// anew by more than an age tells, so that whoever is told a time twice hears
/// the same.
inline int64_t wall_clock_ahead_ms() {
  constexpr int64_t noticed = 2000;
  static std::atomic<int64_t> known{0};
  const auto ahead = clock_ms(CLOCK_REALTIME) - node_time_ms();
  if (std::abs(ahead - known) >= noticed)
    known = ahead;
  return known;
}

// Times as text; "-" for one that no calendar has.

/// As ISO 8601 writes it, in UTC: "2026-11-22T17:01:02.345Z".
std::string iso_time(int64_t unix_ms);

/// In the time of this place: "2026-11-21 14:03:07.250".
std::string local_time(int64_t unix_ms);

} // namespace roscell
