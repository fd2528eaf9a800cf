#include "tools/instance_shim/process_attributes.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

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

} // namespace roscell::shim
