#include "skills/engine/life/signal_watch.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

namespace roscell::engine {

namespace {

sigset_t watched_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGTERM);
  ::sigaddset(&set, SIGINT);
  ::sigaddset(&set, SIGUSR1);
  return set;
}

} // namespace

void block_signals() {
  auto set = watched_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

signal_watch::signal_watch(std::function<void()> on_stop,
                           std::function<void()> on_safety_wanted)
    : on_stop_(std::move(on_stop)),
      on_safety_wanted_(std::move(on_safety_wanted)) {
  auto set = watched_signals();
  signals_ = unique_fd{::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK)};
  if (!signals_)
    throw std::system_error(errno, std::generic_category(), "signalfd");
  thread_ = std::thread{[this] { run(); }};
}

signal_watch::~signal_watch() {
  stop_.set();
  thread_.join();
}

void signal_watch::run() {
  while (stop_.wait_readable(signals_.get())) {
    signalfd_siginfo reported{};
    if (::read(signals_.get(), &reported, sizeof(reported)) != sizeof(reported))
      continue;
    if (reported.ssi_signo != SIGUSR1)
      return on_stop_();
    on_safety_wanted_();
  }
}

} // namespace roscell::engine
