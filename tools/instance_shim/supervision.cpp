#include "tools/instance_shim/supervision.hpp"

#include "tools/instance_shim/child.hpp"
#include "tools/instance_shim/log_files.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace roscell::shim {

namespace {

/// Of 16 KiB each: the most that a pipe can hold by default for a privileged
/// user is 1 MiB.
constexpr int max_last_portions = 64;

/// Moves one portion of output into the log. Returns whether there may be
/// more now.
bool drain(int output, log_files& log) {
  static char buffer[16384];
  auto n = ::read(output, buffer, sizeof(buffer));
  if (n > 0)
    log.write(buffer, static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

/// Returns whether the child has ended.
bool on_signal(supervision& x) {
  signalfd_siginfo info{};
  auto ended = false;
  while (::read(x.signals, &info, sizeof(info)) == sizeof(info)) {
    x.terminated = x.terminated || info.ssi_signo == SIGTERM;
    // The numbers of a child that has ended may be a stranger's by now.
    if (info.ssi_signo == SIGCHLD)
      ended = reap(x.child, x.wait_status) || ended;
    else if (ended)
      continue;
    else if (info.ssi_signo == SIGTERM)
      ::kill(-x.child, x.stop_signal);
    else if (info.ssi_signo == SIGQUIT)
      ::kill(-x.child, SIGKILL);
    else
      ::kill(x.child, SIGUSR1);
  }
  // What a killed process has left behind is now a child of the shim.
  if (x.fenced && !ended)
    kill_all(x.child);
  return ended;
}

void on_timer(supervision& x) {
  if (!x.limit->has_passed())
    return;
  x.fenced = true;
  kill_all(x.child);
}

void await_end(supervision& x) {
  pollfd waited[] = {{x.signals, POLLIN, 0},
                     {x.output, POLLIN, 0},
                     {x.limit->timer(), POLLIN, 0}};
  for (;;) {
    if (::poll(waited, 3, -1) < 1)
      continue; // Interrupted.
    if (waited[2].revents != 0) {
      on_timer(x);
      // The kernel kills all of a container when its first process ends, even
      // what that may not kill or what does not obey.
      if (x.fenced && x.log == nullptr) {
        x.wait_status = SIGKILL;
        return;
      }
      // A moment that has passed stays so.
      waited[2].fd = x.fenced ? -1 : waited[2].fd;
    }
    if (waited[0].revents != 0 && on_signal(x))
      return;
    // The child may close its output long before it ends.
    if (waited[1].revents != 0 && !drain(x.output, *x.log))
      waited[1].fd = -1;
  }
}

} // namespace

int open_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (auto number : {SIGTERM, SIGQUIT, SIGUSR1, SIGCHLD})
    ::sigaddset(&set, number);
  ::sigprocmask(SIG_SETMASK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

void supervise(supervision& x) {
  await_end(x);
  kill_leftovers(x.child, x.signals);
  // A process that could not be killed may still hold the other end.
  for (auto i = 0;
       x.log != nullptr && i < max_last_portions && drain(x.output, *x.log);
       ++i) {
    // Until the pipe is empty.
  }
}

} // namespace roscell::shim
