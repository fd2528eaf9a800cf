#pragma once

#include <string>

namespace roscell::cli {

/// Tells whoever started this process that it is ready and that it stops: the
/// service manager at $NOTIFY_SOCKET, in systemd's protocol, and the reader of
/// a file descriptor, who gets the line "READY=1" and then its end.
class readiness {
public:
  /// Takes NOTIFY_SOCKET out of the environment, so that no child speaks in
  /// our name. `fd` is negative for none.
  explicit readiness(int fd);

  void ready();

  /// The node cannot start yet. The manager is shown why, and goes on with its
  /// boot: it would end a service that takes too long to be ready. The reader
  /// hears of it no earlier than of a node that can be asked.
  void waiting(const std::string& why);

  void stopping();

private:
  void notify(const std::string& state) const;

  std::string socket_;
  int fd_;
  bool waited_ = false;
};

} // namespace roscell::cli
