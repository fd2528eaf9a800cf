#include "tools/roscell/top/terminal/signals.hpp"

#include "tools/roscell/exit_code.hpp"

#include <sys/signalfd.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

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

namespace {

constexpr std::array crashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

/// Read in a signal handler, which may use nothing that is made there.
termios modes_before{};
std::array<char, 256> farewell{};
size_t farewell_length = 0;

extern "C" void restore_and_crash(int signal) {
  tcsetattr(STDIN_FILENO, TCSANOW, &modes_before);
  [[maybe_unused]] const auto written =
      write(STDOUT_FILENO, farewell.data(), farewell_length);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

} // namespace

crash_guard::crash_guard() {
  tcgetattr(STDIN_FILENO, &modes_before);
  for (const auto x : crashes)
    std::signal(x, restore_and_crash);
}

crash_guard::~crash_guard() {
  for (const auto x : crashes)
    std::signal(x, SIG_DFL);
}

void crash_guard::remember_farewell(const char* text) {
  const auto length = std::strlen(text);
  if (farewell_length + length > farewell.size())
    return;
  std::memcpy(farewell.data() + farewell_length, text, length);
  farewell_length += length;
}

} // namespace roscell::cli::top
