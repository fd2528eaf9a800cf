/// Starts one command, keeps its output in a bounded log, and records how it
/// ended. A node starts one shim for each process instance; the shim and the
/// command survive the node, and a restarted node finds them by the record
/// `pid`. Single-threaded, and sleeps unless there is output or a signal.
///
/// In the folder DIR:
///   pid           "<shim pid> <shim start time> <child pid>", once started
///   log.<offset>  output of the command from that byte on; at most two files
///   exit          {"code","signal","at_unix_ms"}, durable before the shim ends
///   *.tmp         not yet complete; to be ignored
///
/// SIGTERM to the shim is passed on to the command's process group, as the
/// signal that the shim was told, SIGQUIT
/// kills that group. The shim closes the stdout and stderr it was given when
/// `pid` is written; what comes out of them before is the reason for a failure.
/// Exit code: 0 when `exit` is written, 1 for a failure, 2 for wrong usage.

#include "tools/instance_shim/child.hpp"
#include "tools/instance_shim/log_files.hpp"
#include "tools/instance_shim/options.hpp"
#include "tools/instance_shim/records.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <initializer_list>

namespace roscell::shim {

namespace {

/// Of 16 KiB each: the most that a pipe can hold by default for a privileged
/// user is 1 MiB.
constexpr int max_last_portions = 64;

int complain(const char* what, const char* subject) {
  ::dprintf(STDERR_FILENO, "roscell-instance-shim: cannot %s %s: %s\n", what,
            subject, std::strerror(errno));
  return 1;
}

/// Cuts the ties to the process that started the shim.
void detach() {
  // Fails for the leader of a process group, which a node never starts.
  ::setsid();
  // A standard stream that is missing would be mistaken for the next file
  // that is opened.
  auto filled = 0;
  while (filled >= 0 && filled <= STDERR_FILENO)
    filled = ::open("/dev/null", O_RDWR);
  ::close_range(3, ~0U, 0);
  // Descendants that lose their parent become children of the shim, so that
  // none is left when the instance ends.
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  for (auto number : {SIGHUP, SIGINT, SIGPIPE, SIGXFSZ})
    ::signal(number, SIG_IGN);
}

int open_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGTERM);
  ::sigaddset(&set, SIGQUIT);
  ::sigaddset(&set, SIGCHLD);
  ::sigprocmask(SIG_SETMASK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Makes the folder if need be. Returns a descriptor, or -1 with errno set.
int open_directory(const char* path) {
  if (::mkdir(path, 0750) != 0 && errno != EEXIST)
    return -1;
  return ::open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

void release_standard_streams() {
  auto null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (auto fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::dup2(null, fd);
}

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
bool on_signal(int signals, pid_t child, int stop_signal, int& wait_status) {
  signalfd_siginfo info{};
  auto ended = false;
  while (::read(signals, &info, sizeof(info)) == sizeof(info)) {
    if (info.ssi_signo == SIGTERM)
      ::kill(-child, stop_signal);
    else if (info.ssi_signo == SIGQUIT)
      ::kill(-child, SIGKILL);
    else
      ended = reap(child, wait_status) || ended;
  }
  return ended;
}

/// Returns the wait status of the child when it has ended.
int supervise(pid_t child, int output, int signals, int stop_signal,
              log_files& log) {
  auto wait_status = 0;
  pollfd waited[] = {{signals, POLLIN, 0}, {output, POLLIN, 0}};
  for (;;) {
    if (::poll(waited, 2, -1) < 1)
      continue; // Interrupted.
    if (waited[0].revents != 0
        && on_signal(signals, child, stop_signal, wait_status))
      return wait_status;
    // The child may close its output long before it ends.
    if (waited[1].revents != 0 && !drain(output, log))
      waited[1].fd = -1;
  }
}

int run(const options& o) {
  detach();
  auto signals = open_signals();
  auto directory = open_directory(o.directory);
  if (directory < 0)
    return complain("open", o.directory);
  int pipe[2] = {-1, -1};
  if (signals < 0 || ::pipe2(pipe, O_CLOEXEC) != 0)
    return complain("make", "pipes");
  ::fcntl(pipe[0], F_SETFL, O_NONBLOCK);
  exit_record record{directory};
  log_files log{directory, o.log_bytes};
  auto child = start_child(o, pipe[1]);
  if (child < 0)
    return complain("start", o.command[0]);
  ::close(pipe[1]);
  if (!write_pid(directory, child)) {
    auto result = complain("write pid in", o.directory);
    kill_leftovers(child, signals);
    return result;
  }
  release_standard_streams();
  auto wait_status = supervise(child, pipe[0], signals, o.stop_signal, log);
  kill_leftovers(child, signals);
  // A process that could not be killed may still hold the other end.
  for (auto i = 0; i < max_last_portions && drain(pipe[0], log); ++i) {
    // Until the pipe is empty.
  }
  return record.write(wait_status, log) ? 0 : 1;
}

} // namespace

} // namespace roscell::shim

int main(int argc, char** argv) {
  roscell::shim::options o;
  return roscell::shim::read_options(argc, argv, o) ? roscell::shim::run(o) : 2;
}
