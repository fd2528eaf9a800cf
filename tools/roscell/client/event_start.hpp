#pragma once

#include <cstdint>
#include <string>

namespace roscell::cli {

/// Where events are wanted from.
struct event_start {
  uint64_t number = 0; ///< Those after it,
  int64_t unix_ms = 0; ///< from the first one on that is not older; 0: all.
  bool on_disk = true; ///< Also those that are not in memory any more.
};

/// From what people write: a number, where 0 means what is in memory; `start`,
/// a span such as `2h` or `7d`, a moment such as `2026-11-25`, `2026-11-25
/// 08:00`, `2026-11-25T08:00:30Z`, or `08:00`, the last one that was. Without Z
/// a moment is by this host's clock. Throws std::invalid_argument that says
/// what can be written.
event_start parse_event_start(const std::string& text, int64_t now_unix_ms);

} // namespace roscell::cli
