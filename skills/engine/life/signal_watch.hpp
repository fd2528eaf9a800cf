#pragma once

#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <thread>

namespace roscell::engine {

/// Blocks SIGTERM and SIGINT for good in the calling thread and in those it
/// starts later, so that a signal_watch can receive them.
void block_stop_signals();

/// Calls `on_signal` once, on a thread of its own, when SIGTERM or SIGINT
/// arrives or has arrived since block_stop_signals(). Once the destructor has
/// returned, the call has happened or never will.
class signal_watch {
public:
  explicit signal_watch(std::function<void()> on_signal);

  ~signal_watch();

private:
  unique_fd signals_;
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
