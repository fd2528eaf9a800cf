#include "tools/instance_shim/supervision.hpp"

#include "tools/instance_shim/child.hpp"
#include "tools/instance_shim/log_files.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <initializer_list>

namespace roscell::shim {

namespace {

std::int64_t boot_now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

/// Returns false with errno set where there is no whole number.
bool read_once(int file, std::int64_t& result) {
  const auto n = ::pread(file, &result, sizeof(result), 0);
  if (n >= 0 && n != static_cast<ssize_t>(sizeof(result)))
    errno = ENODATA;
  return n == static_cast<ssize_t>(sizeof(result));
}

/// A number that is just being written could be read half and be any time: it
/// counts when it is read twice. It is written every few seconds at most.
bool read_moment(const char* path, std::int64_t& result) {
  constexpr int attempts = 3;
  const auto file = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return false;
  auto good = read_once(file, result);
  auto settled = false;
  for (auto i = 0; i < attempts && good && !settled; ++i) {
    const auto before = result;
    good = read_once(file, result);
    settled = before == result;
  }
  const auto why = good ? EAGAIN : errno;
  ::close(file);
  errno = why;
  return good && settled;
}

} // namespace

fence::~fence() {
  if (timer_ >= 0)
    ::close(timer_);
}

bool fence::hold(const char* path) {
  path_ = path;
  timer_ = ::timerfd_create(CLOCK_BOOTTIME, TFD_CLOEXEC | TFD_NONBLOCK);
  std::int64_t moment = 0;
  if (timer_ < 0 || !read_moment(path_, moment))
    return false;
  if (moment > boot_now_ms())
    return wait_until(moment);
  errno = ETIME;
  return false;
}

bool fence::has_passed() {
  std::int64_t moment = 0;
  return !read_moment(path_, moment) || moment <= boot_now_ms()
         || !wait_until(moment);
}

bool fence::wait_until(std::int64_t boot_ms) const {
  itimerspec when{};
  when.it_value.tv_sec = boot_ms / 1000;
  when.it_value.tv_nsec = boot_ms % 1000 * 1'000'000;
  return ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr) == 0;
}

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

void say(supervision& x, const char* text) {
  if (x.log != nullptr)
    x.log->write(text, std::strlen(text));
  else
    ::dprintf(STDERR_FILENO, "%s", text);
}

/// Whoever has a process group of its own has not heard the child's, and what a
/// shell has started in the background is deaf to SIGINT and SIGQUIT.
void pass_to_who_has_not_heard(pid_t process, void* context) {
  const auto& x = *static_cast<const supervision*>(context);
  if (ignores_signal(process, x.stop_signal))
    ::kill(process, SIGTERM);
  else if (::getpgid(process) != x.child)
    ::kill(process, x.stop_signal);
}

void pass_to_all(pid_t process, void* context) {
  ::kill(process, static_cast<const supervision*>(context)->stop_signal);
}

void ask_to_end(supervision& x) {
  x.terminated = true;
  // The numbers of a child that has ended may be another process's by now.
  if (x.ended)
    visit_descendants(::getpid(), pass_to_all, &x);
  else
    ::kill(-x.child, x.stop_signal);
}

void ask_if_it_listens(pid_t process, void* context) {
  if (takes_signal(process, SIGUSR1) && ::kill(process, SIGUSR1) == 0)
    *static_cast<bool*>(context) = true;
}

/// A shell in front of the program would die of it.
void ask_to_become_stop_safe(supervision& x) {
  auto heard = false;
  if (!x.ended)
    ask_if_it_listens(x.child, &heard);
  if (!heard)
    visit_descendants(::getpid(), ask_if_it_listens, &heard);
  if (!heard)
    say(x, "[shim: nobody here takes SIGUSR1, by which it is asked to be "
           "stop-safe: "
           "it was not sent]\n");
}

void on_child_ended(supervision& x) {
  x.ended = true;
  if (x.terminated)
    visit_descendants(::getpid(), pass_to_who_has_not_heard, &x);
}

/// Whether those that are left have time to end.
bool is_patient(const supervision& x) {
  return x.terminated && !x.forced && !x.fenced;
}

void on_signal(supervision& x) {
  signalfd_siginfo info{};
  while (::read(x.signals, &info, sizeof(info)) == sizeof(info)) {
    if (info.ssi_signo == SIGTERM)
      ask_to_end(x);
    else if (info.ssi_signo == SIGUSR1)
      ask_to_become_stop_safe(x);
    else if (info.ssi_signo == SIGQUIT)
      x.forced = true;
    else if (reap(x.child, x.wait_status, is_patient(x)))
      on_child_ended(x);
  }
  // What a killed process has left behind is now a child of the shim.
  if ((x.fenced || x.forced) && !x.ended)
    kill_all(x.cgroups);
}

void on_timer(supervision& x) {
  if (!x.limit->has_passed())
    return;
  x.fenced = true;
  kill_all(x.cgroups);
}

/// Whoever was attached has gone.
void on_lifeline(supervision& x) {
  x.forced = true;
  if (!x.ended)
    kill_all(x.cgroups);
}

bool is_over(const supervision& x) {
  return x.ended && !(is_patient(x) && has_children());
}

void await_end(supervision& x) {
  pollfd waited[] = {{x.signals, POLLIN, 0},
                     {x.output, POLLIN, 0},
                     {x.limit->timer(), POLLIN, 0},
                     {x.lifeline, POLLIN, 0}};
  while (!is_over(x)) {
    if (::poll(waited, 4, -1) < 1)
      continue; // Interrupted.
    if (waited[2].revents != 0) {
      on_timer(x);
      // The kernel kills all of a container when its first process ends, even
      // what that may not kill or what does not obey.
      if (x.fenced && x.log == nullptr) {
        x.wait_status = x.ended ? x.wait_status : SIGKILL;
        return;
      }
      // A moment that has passed stays so.
      waited[2].fd = x.fenced ? -1 : waited[2].fd;
    }
    if (waited[3].revents != 0) {
      on_lifeline(x);
      waited[3].fd = -1;
    }
    if (waited[0].revents != 0)
      on_signal(x);
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
  kill_leftovers(x.cgroups, x.signals);
  // A process that could not be killed may still hold the other end.
  for (auto i = 0;
       x.log != nullptr && i < max_last_portions && drain(x.output, *x.log);
       ++i) {
    // Until the pipe is empty.
  }
}

} // namespace roscell::shim
