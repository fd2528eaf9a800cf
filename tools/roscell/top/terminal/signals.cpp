#include "tools/roscell/top/terminal/signals.hpp"

#include "tools/roscell/exit_code.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

namespace roscell::cli::top {

namespace {

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t result;
  sigemptyset(&result);
  for (const auto x : signals)
    sigaddset(&result, x);
  return result;
}

/// Whoever has started us with it ignored would not bring us back.
bool may_be_stopped() {
  struct sigaction now {};
  sigaction(SIGTSTP, nullptr, &now);
  return now.sa_handler != SIG_IGN;
}

} // namespace

terminal_signals::terminal_signals() {
  auto wanted = set_of({SIGWINCH, SIGCONT, SIGINT, SIGTERM, SIGQUIT, SIGHUP});
  if (may_be_stopped())
    sigaddset(&wanted, SIGTSTP);
  pthread_sigmask(SIG_BLOCK, &wanted, &before_);
  fd_ = signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK);
  if (fd_ < 0)
    throw command_error{exit_refused, "too many open files"};
}

terminal_signals::~terminal_signals() {
  close(fd_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

std::optional<int> terminal_signals::take() {
  signalfd_siginfo taken{};
  if (read(fd_, &taken, sizeof taken) != sizeof taken)
    return std::nullopt;
  return static_cast<int>(taken.ssi_signo);
}

void terminal_signals::stop_here() {
  const auto stop = set_of({SIGTSTP});
  std::signal(SIGTSTP, SIG_DFL);
  std::raise(SIGTSTP);
  // It waits until here, and is delivered before this returns.
  pthread_sigmask(SIG_UNBLOCK, &stop, nullptr);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
}

} // namespace roscell::cli::top
