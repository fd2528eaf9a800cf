#pragma once

#include <chrono>

namespace roscell::cli {

/// Waits for SIGINT and SIGTERM, or for `end`, without a signal handler.
/// Blocks both signals for the calling thread and those it makes later.
class stop_signals {
public:
  enum class cause { signal, ended, timeout };

  stop_signals();
  ~stop_signals();

  stop_signals(const stop_signals&) = delete;
  stop_signals& operator=(const stop_signals&) = delete;

  cause wait();
  cause wait_for(std::chrono::milliseconds limit);

  /// What is waited for has ended by itself; from any thread. Ends one wait.
  void end();

private:
  cause poll_once(int timeout_ms);

  int signal_fd_;
  int event_fd_;
};

} // namespace roscell::cli
