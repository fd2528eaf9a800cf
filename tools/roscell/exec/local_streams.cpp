#include "tools/roscell/exec/local_streams.hpp"

#include "tools/roscell/exec/raw_terminal.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

/// As much as one request takes.
constexpr size_t input_bytes = 64UL * 1024;

/// What a pipe takes at once when it says that it can be written.
constexpr size_t output_bytes = 4096;

/// A reader of ours that is slower than this has the command told that somebody
/// is there: a part of its lease (actors/edge/exec/limits.hpp).
constexpr int slow_reader_ms = 4000;

constexpr int signal_base = 128;

} // namespace

taken_signals::taken_signals() {
  sigset_t ours;
  sigemptyset(&ours);
  for (const int x : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH})
    sigaddset(&ours, x);
  pthread_sigmask(SIG_BLOCK, &ours, &before_);
  fd_ = ::signalfd(-1, &ours, SFD_CLOEXEC | SFD_NONBLOCK);
  // Whoever has gone is seen by an error of the write.
  ::signal(SIGPIPE, SIG_IGN);
}

taken_signals::~taken_signals() {
  ::close(fd_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

local_streams::local_streams(remote_command& command,
                             const attachment_options& how,
                             const taken_signals& signals,
                             std::function<void()> restore_terminal)
    : command_{command}, how_{how}, signals_{signals},
      restore_terminal_{std::move(restore_terminal)}, stop_{::eventfd(
                                                          0, EFD_CLOEXEC)},
      input_{[this] { pass_input(); }}, watch_{[this] { watch_signals(); }} {
  // nop
}

local_streams::~local_streams() {
  ::eventfd_write(stop_, 1);
  input_.join();
  watch_.join();
  ::close(stop_);
}

/// False: it is over.
bool local_streams::await(int fd) const {
  std::array<pollfd, 2> waited{{{fd, POLLIN, 0}, {stop_, POLLIN, 0}}};
  while (::poll(waited.data(), waited.size(), -1) < 0 && errno == EINTR) {
    // Again.
  }
  return waited[1].revents == 0;
}

void local_streams::pass_input() {
  std::vector<char> buffer(input_bytes);
  try {
    bool more = !how_.no_input;
    while (more && await(STDIN_FILENO)) {
      const auto n = ::read(STDIN_FILENO, buffer.data(), buffer.size());
      if (n < 0 && (errno == EINTR || errno == EAGAIN))
        continue;
      more = n > 0;
      if (more)
        command_.give({buffer.data(), static_cast<size_t>(n)}, false);
    }
    if (!more)
      command_.give({}, true);
  } catch (const std::exception&) {
    // Whoever reads its output hears what has become of it.
  }
}

void local_streams::watch_signals() {
  signalfd_siginfo taken{};
  while (await(signals_.fd()))
    while (::read(signals_.fd(), &taken, sizeof(taken)) == sizeof(taken))
      on_signal(static_cast<int>(taken.ssi_signo));
}

void local_streams::on_signal(int number) {
  if (number != SIGWINCH) {
    command_.hang_up();
    restore_terminal_();
    ::_exit(signal_base + number);
  }
  try {
    if (how_.terminal)
      command_.resize(size_of_terminal());
  } catch (const std::exception&) {
    // The same.
  }
}

bool write_all(int fd, std::string_view bytes, const remote_command& command) {
  while (!bytes.empty()) {
    pollfd waited{fd, POLLOUT, 0};
    const int ready = ::poll(&waited, 1, slow_reader_ms);
    if (ready == 0)
      command.stay();
    if (ready <= 0)
      continue;
    const auto part = bytes.substr(0, output_bytes);
    const auto n = ::write(fd, part.data(), part.size());
    if (n < 0 && errno != EINTR && errno != EAGAIN)
      return false;
    if (n > 0)
      bytes.remove_prefix(static_cast<size_t>(n));
  }
  return true;
}

} // namespace roscell::cli
