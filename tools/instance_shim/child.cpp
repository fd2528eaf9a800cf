#include "tools/instance_shim/child.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace roscell::shim {

namespace {

/// Descendants are killed in rounds, for a killed process may have started
/// another one meanwhile. Together at most one second.
constexpr int kill_rounds = 20;
constexpr int kill_round_ms = 50;

[[noreturn]] void fail(const char* what, const char* subject) {
  ::dprintf(STDERR_FILENO, "shim: cannot %s '%s': %s\n", what, subject,
            std::strerror(errno));
  ::_exit(127);
}

void reset_signals() {
  // What the shim ignores would stay ignored across execve.
  for (auto number : {SIGHUP, SIGINT, SIGPIPE, SIGXFSZ})
    ::signal(number, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

[[noreturn]] void become(const options& o, pid_t shim, int output) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The shim may have died before the line above took effect.
  if (::getppid() != shim)
    ::_exit(127);
  reset_signals();
  auto null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(null, STDIN_FILENO);
  // Without a log it has the shim's own.
  if (output >= 0) {
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
  }
  if (o.working_dir != nullptr && ::chdir(o.working_dir) != 0)
    fail("change to folder", o.working_dir);
  ::execvp(o.command[0], o.command);
  fail("run", o.command[0]);
}

/// Deeper ones come up when those above them have ended.
constexpr int most_levels = 64;

/// The children that one thread has started, as text: "PID PID ".
bool read_children(pid_t process, const char* thread, char* text, size_t room) {
  char path[64];
  std::snprintf(path, sizeof(path), "/proc/%d/task/%.16s/children", process,
                thread);
  auto fd = ::open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return false;
  auto size = ::read(fd, text, room - 1);
  ::close(fd);
  if (size <= 0)
    return false;
  text[size] = '\0';
  // A list that was cut may end with a part of a number.
  if (text[size - 1] != ' ')
    *(std::strrchr(text, ' ') + 1) = '\0';
  return true;
}

/// Kills the descendants of a process, the deepest first: the children of one
/// that has ended have another parent. Returns whether there were any.
bool kill_descendants(pid_t process, int level = 0) {
  char path[64];
  char text[4096];
  auto any = false;
  std::snprintf(path, sizeof(path), "/proc/%d/task", process);
  auto* threads = level < most_levels ? ::opendir(path) : nullptr;
  if (threads == nullptr)
    return false;
  while (const auto* entry = ::readdir(threads)) {
    if (entry->d_name[0] == '.'
        || !read_children(process, entry->d_name, text, sizeof(text)))
      continue;
    any = true;
    char* rest = nullptr;
    for (const char* at = text; *at >= '0' && *at <= '9'; at = rest + 1) {
      auto child = static_cast<pid_t>(std::strtol(at, &rest, 10));
      kill_descendants(child, level + 1);
      ::kill(child, SIGKILL);
    }
  }
  ::closedir(threads);
  return any;
}

} // namespace

pid_t start_child(const options& o, int output) {
  auto shim = ::getpid();
  auto child = ::fork();
  if (child == 0)
    become(o, shim, output);
  // The group must exist before the first signal is passed on, whoever of the
  // two runs first.
  if (child > 0)
    ::setpgid(child, child);
  return child;
}

bool reap(pid_t child, int& wait_status) {
  auto ended = false;
  siginfo_t info{};
  while (::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0
         && info.si_pid != 0) {
    auto status = 0;
    // As long as the child is not reaped, its number cannot have become that
    // of a stranger's process group.
    if (info.si_pid == child)
      ::kill(-child, SIGKILL);
    ::waitpid(info.si_pid, &status, 0);
    if (info.si_pid == child) {
      ended = true;
      wait_status = status;
    }
    info.si_pid = 0;
  }
  return ended;
}

void kill_all(pid_t child) {
  ::kill(-child, SIGKILL);
  kill_descendants(::getpid());
}

void kill_leftovers(pid_t child, int signals) {
  auto status = 0;
  for (auto round = 0; round < kill_rounds && kill_descendants(::getpid());
       ++round) {
    pollfd waited{signals, POLLIN, 0};
    ::poll(&waited, 1, kill_round_ms);
    signalfd_siginfo taken{};
    [[maybe_unused]] auto n = ::read(signals, &taken, sizeof(taken));
    reap(child, status);
  }
}

} // namespace roscell::shim
