#pragma once

#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
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

} // namespace roscell::engine
