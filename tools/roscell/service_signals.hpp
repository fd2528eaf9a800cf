#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

namespace roscell::cli {

/// Whether SIGHUP, which a terminal sends too when it is closed, says anything
/// to a process. It ends none that waits for `stop_signals`.
enum class hangups { ignored, heard };

/// Waits for SIGINT and SIGTERM, or for `end`, without a signal handler.
/// Blocks both signals for the calling thread and those it makes later, and
/// SIGHUP where that is heard.
class stop_signals {
public:
  using time_point = std::chrono::steady_clock::time_point;

  enum class cause { signal, ended, news, timeout, hangup, renewal };

  explicit stop_signals(hangups about = hangups::ignored);
  ~stop_signals();

  stop_signals(const stop_signals&) = delete;
  stop_signals& operator=(const stop_signals&) = delete;

  cause wait();
  cause wait_for(std::chrono::milliseconds limit);

  /// The same until `until`, or without end; `news` where `fd` can be read, and
  /// `hangup` for all SIGHUPs since the last one: nothing else waits for them.
  cause wait_with(int fd, std::optional<time_point> until);

  /// What is waited for has ended by itself; from any thread. Ends one wait.
  void end();

  /// The same: it is to be made anew.
  void renew();

private:
  cause poll_once(int fd, int hangup_fd, int timeout_ms);

  int signal_fd_;
  int hangup_fd_ = -1; ///< Negative: SIGHUP is ignored.
  int event_fd_;
  std::atomic<bool> renewing_{false};
};

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
