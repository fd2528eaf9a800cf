#include "skills/engine/life/signal_watch.hpp"

#include <sys/signalfd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

namespace roscell::engine {

namespace {

sigset_t stop_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGTERM);
  ::sigaddset(&set, SIGINT);
  return set;
}

} // namespace

void block_stop_signals() {
  auto set = stop_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

signal_watch::signal_watch(std::function<void()> on_signal) {
  auto set = stop_signals();
  signals_ = unique_fd{::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK)};
  if (!signals_)
    throw std::system_error(errno, std::generic_category(), "signalfd");
  thread_ = std::thread{[this, call = std::move(on_signal)] {
    if (stop_.wait_readable(signals_.get()))
      call();
  }};
}

signal_watch::~signal_watch() {
  stop_.set();
  thread_.join();
}

} // namespace roscell::engine
