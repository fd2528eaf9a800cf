#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Blocks SIGTERM, SIGINT and SIGUSR1 for good in the calling thread and in
/// those it starts later, so that a signal_watch can receive them.
void block_signals();

/// Waits, on a thread of its own, for what a skill is told by signals. SIGTERM
/// and SIGINT: it is to end; `on_stop` is called once, and nothing after it.
/// SIGUSR1: somebody waits for it to be stop-safe; `on_safety_wanted` is called
/// each time. Signals since block_signals() count. Once the destructor has
/// returned there are no more calls.
class signal_watch {
public:
  signal_watch(std::function<void()> on_stop,
               std::function<void()> on_safety_wanted);

  ~signal_watch();

private:
  void run();

  const std::function<void()> on_stop_;
  const std::function<void()> on_safety_wanted_;
  unique_fd signals_;
  stop_event stop_;
  std::thread thread_;
};

/// Hears, on a thread of its own, that the cell is to be found elsewhere: where
/// this host has got another address the node writes variables with their new
/// values, as a JSON object of texts on a line, into the FIFO
/// `$NOTIFY_SOCKET.environment` that it has made. By its having a reader the
/// node knows that somebody listens.
class environment_watch {
public:
  using callback = std::function<void(changed_variables)>;

  /// Hears nothing where there is no such FIFO: the node then starts the skill
  /// again.
  environment_watch(const std::string& notify_socket, callback on_change);

  /// There are no calls after it.
  ~environment_watch();

private:
  void run();
  void take();
  void obey(const std::string& line);

  const callback on_change_;
  unique_fd fifo_;
  std::string heard_; ///< Of a line that has not ended.
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
