#pragma once

#include <chrono>
#include <optional>

namespace roscell::cli {

/// Waits for SIGINT and SIGTERM, or for `end`, without a signal handler.
/// Blocks both signals for the calling thread and those it makes later. SIGHUP
/// is ignored by the process from then on.
class stop_signals {
public:
  using time_point = std::chrono::steady_clock::time_point;

  enum class cause { signal, ended, news, timeout };

  stop_signals();
  ~stop_signals();

  stop_signals(const stop_signals&) = delete;
  stop_signals& operator=(const stop_signals&) = delete;

  cause wait();
  cause wait_for(std::chrono::milliseconds limit);

  /// The same until `until`, or without end; `news` where `fd` can be read.
  cause wait_with(int fd, std::optional<time_point> until);

  /// What is waited for has ended by itself; from any thread. Ends one wait.
  void end();

private:
  cause poll_once(int fd, int timeout_ms);

  int signal_fd_;
  int event_fd_;
};

} // namespace roscell::cli
