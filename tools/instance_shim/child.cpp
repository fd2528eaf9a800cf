#include "tools/instance_shim/child.hpp"

#include "tools/instance_shim/options.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <sched.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace roscell::shim {

namespace {

constexpr const char* score_file = "/proc/self/oom_score_adj";
constexpr int never_ended = -1000;
constexpr int most_score = 1000;

/// Above a shim that may not go lower.
constexpr int score_step = 100;

/// As linux/ioprio.h has it, which is newer than some hosts.
constexpr int io_of_process = 1;
constexpr int io_class_none = 0;

int read_score() {
  char text[16] = {};
  const auto file = ::open(score_file, O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return 0;
  [[maybe_unused]] auto n = ::read(file, text, sizeof(text) - 1);
  ::close(file);
  return std::atoi(text);
}

bool write_score(int score) {
  char text[16];
  const auto size = std::snprintf(text, sizeof(text), "%d", score);
  const auto file = ::open(score_file, O_WRONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const auto done = ::write(file, text, static_cast<std::size_t>(size)) == size;
  ::close(file);
  return done;
}

/// It may not raise itself beyond that, as the node's limits might allow.
void bound_raises(const scheduling& request) {
  const auto priority = static_cast<rlim_t>(request.priority);
  const rlimit highest{priority, priority};
  ::setrlimit(RLIMIT_RTPRIO, &highest);
  // As the kernel counts it: 20 for nice 0, 40 for -20.
  const auto ceiling = static_cast<rlim_t>(20 - request.nice);
  const rlimit nicest{ceiling, ceiling};
  ::setrlimit(RLIMIT_NICE, &nicest);
  rlimit core{};
  ::getrlimit(RLIMIT_CORE, &core);
  core.rlim_cur = 0;
  ::setrlimit(RLIMIT_CORE, &core);
}

/// Those that execve(2) would hand on to a program that is not root's.
void drop_handed_on() {
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct who{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct what[2] = {};
  if (::syscall(SYS_capget, &who, what) != 0)
    return;
  what[0].inheritable = what[1].inheritable = 0;
  ::syscall(SYS_capset, &who, what);
}

} // namespace

void be_the_last_to_go() {
  if (read_score() > never_ended)
    write_score(never_ended);
}

void become_ordinary() {
  const auto shim = read_score();
  const auto score = shim < 0 ? 0 : shim + score_step;
  write_score(score < most_score ? score : most_score);
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_OTHER, &none);
  ::setpriority(PRIO_PROCESS, 0, 0);
  ::syscall(SYS_ioprio_set, io_of_process, 0, io_class_none);
  ::umask(022);
  drop_handed_on();
}

bool take_scheduling(const scheduling& request) {
  if (request.nice != 0 && ::setpriority(PRIO_PROCESS, 0, request.nice) != 0)
    return false;
  sched_param priority{};
  priority.sched_priority = request.priority;
  if (request.policy != SCHED_OTHER
      && ::sched_setscheduler(0, request.policy, &priority) != 0)
    return false;
  bound_raises(request);
  return true;
}

namespace {

/// Descendants are killed in rounds, for a killed process may have started
/// another one meanwhile. Together at most one second.
constexpr int kill_rounds = 20;
constexpr int kill_round_ms = 50;

/// Who tells a person that a command cannot be run.
const char* speaker = "shim";

[[noreturn]] void fail(const char* what, const char* subject) {
  ::dprintf(STDERR_FILENO, "%s: cannot %s '%s': %s\n", speaker, what, subject,
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
    ::dprintf(STDERR_FILENO, "%s: cannot run '%s': its interpreter '%s'%s\n",
              speaker, program, interpreter,
              foreign ? " has a CR behind it: its lines end as on Windows"
                      : " is not there");
    ::_exit(127);
  }
  if (why == ENOENT && size > 2) {
    ::dprintf(STDERR_FILENO,
              "%s: cannot run '%s': what loads it is not there (`file` names "
              "it)\n",
              speaker, program);
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

/// A terminal is of one session, whose first process begins it.
void take_streams(attachment attached) {
  if (attached == attachment::terminal) {
    ::setsid();
    ::ioctl(STDIN_FILENO, TIOCSCTTY, 0);
    return;
  }
  ::setpgid(0, 0);
  if (attached == attachment::pipes)
    return;
  auto null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(null, STDIN_FILENO);
}

[[noreturn]] void become(const options& o, pid_t shim, int output,
                         bool inside) {
  take_streams(o.attached);
  die_with(shim);
  reset_signals();
  if (o.attached != attachment::none)
    speaker = "roscell exec";
  // Without a log it has the shim's own.
  if (output >= 0) {
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
  }
  // An ordinary one first: a cgroup may refuse what is scheduled in real time.
  become_ordinary();
  if (!inside)
    enter(o.cgroups);
  if (!take_scheduling(o.request))
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
  // two runs first. The leader of one could begin no session.
  if (child > 0 && o.attached != attachment::terminal)
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
    // of another program's process group.
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
