#pragma once

#include "skills/engine/life/unique_fd.hpp"

#include <sys/un.h>

#include <string>

namespace roscell::engine {

/// Sends state to whoever supervises the skill, in the datagram protocol of
/// systemd's sd_notify(3).
class notify_socket {
public:
  /// `name` is the value of NOTIFY_SOCKET; if it is empty, nothing is ever
  /// sent. Throws start_error when it is no absolute path or abstract name.
  explicit notify_socket(const std::string& name);

  bool enabled() const noexcept {
    return static_cast<bool>(fd_);
  }

  /// Sends e.g. "READY=1". Waits at most one second for a receiver that is
  /// behind. Returns 0 or an errno: a node that restarts has no socket for a
  /// while, which is no reason for a skill to stop.
  int send(const std::string& state) const;

private:
  unique_fd fd_;
  sockaddr_un address_{};
  unsigned address_size_ = 0;
};

} // namespace roscell::engine
