#pragma once

#include <string>
#include <string_view>

namespace roscell {

/// What a program said in the protocol of sd_notify(3).
struct notification {
  bool ready = false;    ///< READY=1
  bool alive = false;    ///< WATCHDOG=1
  bool stopping = false; ///< STOPPING=1
  std::string status;    ///< STATUS=, one line of valid UTF-8.
};

/// Longest datagram that is read; longer ones are ignored whole.
constexpr size_t max_notification_bytes = 4096;

/// Longest status that is kept, in bytes.
constexpr size_t max_status_bytes = 256;

/// Reads one datagram. Unknown and malformed lines are ignored, for programs
/// may say more than we understand.
notification parse_notification(std::string_view datagram);

/// Adds what was said later to what was said before.
void merge(notification& before, notification later);

} // namespace roscell
