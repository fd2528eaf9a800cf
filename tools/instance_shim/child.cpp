#include "tools/instance_shim/child.hpp"

#include "tools/instance_shim/descendants.hpp"
#include "tools/instance_shim/identity.hpp"
#include "tools/instance_shim/standing.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
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

/// Of a script whose interpreter is missing, and of a program whose loader is,
/// the kernel says that they are not there themselves.
[[noreturn]] void fail_to_run(const char* program) {
  const auto why = errno;
  char head[256] = {};
  const auto file = ::open(program, O_RDONLY | O_CLOEXEC);
  const auto size = file < 0 ? 0 : ::read(file, head, sizeof(head) - 1);
  if (why == ENOENT && size > 2 && std::strncmp(head, "#!", 2) == 0) {
    auto* interpreter = head + 2 + std::strspn(head + 2, " \t");
    interpreter[std::strcspn(interpreter, " \t\n")] = '\0';
    auto* end = interpreter + std::strlen(interpreter);
    const auto foreign = end != interpreter && end[-1] == '\r';
    if (foreign)
      end[-1] = '\0';
    ::dprintf(STDERR_FILENO, "shim: cannot run '%s': its interpreter '%s'%s\n",
              program, interpreter,
              foreign ? " has a CR behind it: its lines end as on Windows"
                      : " is not there");
    ::_exit(127);
  }
  if (why == ENOENT && size > 2) {
    ::dprintf(STDERR_FILENO,
              "shim: cannot run '%s': what loads it is not there (`file` names "
              "it)\n",
              program);
    ::_exit(127);
  }
  errno = why;
  fail("run", program);
}

/// How long a program that is being written may take.
constexpr int most_writing_ms = 5000;

/// Gives control to the command, and returns with errno set if it cannot. A
/// program that has just been written may still be open for writing, in what
/// another thread of its writer has forked and has not begun its own program:
/// it is run when the last descriptor is closed.
void run(char* const* command) {
  ::execvp(command[0], command);
  if (errno != ETXTBSY)
    return;
  pollfd closed{::inotify_init1(IN_CLOEXEC), POLLIN, 0};
  ::inotify_add_watch(closed.fd, command[0], IN_CLOSE_WRITE);
  // It may have been closed before the watch.
  ::execvp(command[0], command);
  if (errno == ETXTBSY && ::poll(&closed, 1, most_writing_ms) >= 0)
    ::execvp(command[0], command);
}

void reset_signals() {
  // What the shim ignores would stay ignored across execve.
  for (auto number : {SIGHUP, SIGINT, SIGPIPE, SIGXFSZ})
    ::signal(number, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

void die_with(pid_t shim) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The shim may have died before the line above took effect.
  if (::getppid() != shim)
    ::_exit(127);
}

[[noreturn]] void become(const options& o, pid_t shim, int output,
                         bool inside) {
  ::setpgid(0, 0);
  die_with(shim);
  reset_signals();
  auto null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(null, STDIN_FILENO);
  // Without a log it has the shim's own.
  if (output >= 0) {
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
  }
  // An ordinary one first: a cgroup may refuse what is scheduled in real time.
  become_ordinary();
  if (!inside)
    enter(o.cgroups);
  if (!take_scheduling(o.wish))
    fail("schedule as it was granted", o.command[0]);
  // Last, for the above may need powers that are given up here.
  if (!take_identity(o.who))
    fail("take on the identity of", o.command[0]);
  // A change of the user has cleared it.
  die_with(shim);
  if (o.working_dir != nullptr && ::chdir(o.working_dir) != 0)
    fail("change to folder", o.working_dir);
  run(o.command);
  fail_to_run(o.command[0]);
}

void kill_one(pid_t process, void*) {
  ::kill(process, SIGKILL);
}

bool kill_descendants() {
  return visit_descendants(::getpid(), kill_one, nullptr);
}

} // namespace

pid_t start_child(const options& o, int output) {
  auto shim = ::getpid();
  auto inside = false;
  auto child = fork_into(o.cgroups, inside);
  if (child == 0)
    become(o, shim, output, inside);
  // The group must exist before the first signal is passed on, whoever of the
  // two runs first.
  if (child > 0)
    ::setpgid(child, child);
  return child;
}

bool reap(pid_t child, int& wait_status, bool spares_group) {
  auto ended = false;
  siginfo_t info{};
  while (::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0
         && info.si_pid != 0) {
    auto status = 0;
    // As long as the child is not reaped, its number cannot have become that
    // of a stranger's process group.
    if (info.si_pid == child && !spares_group)
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

bool has_children() {
  siginfo_t info{};
  return ::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0;
}

void kill_all(const cgroup_list& cgroups) {
  kill_members(cgroups);
  kill_descendants();
}

void kill_leftovers(const cgroup_list& cgroups, int signals) {
  auto status = 0;
  for (auto round = 0; round < kill_rounds; ++round) {
    // What has left the cgroup is a descendant still.
    const auto members = kill_members(cgroups);
    if (!kill_descendants() && !members)
      return;
    pollfd waited{signals, POLLIN, 0};
    ::poll(&waited, 1, kill_round_ms);
    signalfd_siginfo taken{};
    [[maybe_unused]] auto n = ::read(signals, &taken, sizeof(taken));
    reap(-1, status, true);
  }
}

} // namespace roscell::shim
