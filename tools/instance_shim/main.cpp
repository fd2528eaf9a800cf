/// Starts one command, keeps its output in a bounded log, and records how it
/// ended. A node starts one shim for each process instance; the shim and the
/// command survive the node, and a restarted node finds them by the record
/// `pid`. Single-threaded, and sleeps unless there is output or a signal.
///
/// In the folder DIR:
///   pid           a link to "<shim pid> <shim start time> <child pid>", which
///                 is no file; once started
///   log.<offset>  output of the command from that byte on; at most two files
///   exit          how it ended, durable before the shim ends; see records.hpp
///   *.tmp         not yet complete; to be ignored
///
/// SIGTERM to the shim is passed on to the command's process group, as the
/// signal that the shim was told; what outlives the command then is waited for.
/// SIGQUIT kills all of it. SIGUSR1 is passed on to the command, or to those of
/// its descendants that take it, and to nobody whom it would end. The shim
/// closes the stdout and stderr it was given when `pid` is written; what comes
/// out of them before is the reason for a failure. Exit code: 0 when `exit` is
/// written, 1 for a failure, 2 for wrong usage.
///
/// With a fence (supervision.hpp) the command and all that it has started is
/// killed when the fence has passed. Nothing is started without it then.
///
/// With cgroups the command is put into them, and ends with all who are there.
/// The shim stays outside: it is neither bounded nor ended along with them.
///
/// A command that somebody is attached to has the shim's own standard streams,
/// leaves no records, and ends with its lifeline: descriptor 3, or in a
/// container a Unix socket, whose other end is with who has started the shim.
/// It is put into cgroups, but ends without those who are there already: it
/// runs beside an instance. The exit code is the command's.
///
/// Without a folder it is the first process of a container, whose engine keeps
/// the log: the output is left alone, and the exit code is that of the command,
/// 128 + n after signal n. How it ended goes into a file of the host as well.

#include "tools/instance_shim/child.hpp"
#include "tools/instance_shim/log_files.hpp"
#include "tools/instance_shim/options.hpp"
#include "tools/instance_shim/records.hpp"
#include "tools/instance_shim/supervision.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <initializer_list>

namespace roscell::shim {

namespace {

int complain(const char* what, const char* subject) {
  ::dprintf(STDERR_FILENO, "roscell-instance-shim: cannot %s %s: %s\n", what,
            subject, std::strerror(errno));
  return 1;
}

/// Cuts the ties to the process that started the shim.
void detach(bool has_lifeline) {
  // Fails for the leader of a process group, which a node never starts.
  ::setsid();
  // A standard stream that is missing would be mistaken for the next file
  // that is opened.
  auto filled = 0;
  while (filled >= 0 && filled <= STDERR_FILENO)
    filled = ::open("/dev/null", O_RDWR);
  ::fcntl(lifeline_place, F_SETFD, FD_CLOEXEC);
  const auto kept = has_lifeline ? 1 : 0;
  ::close_range(static_cast<unsigned>(lifeline_place + kept), ~0U, 0);
  // Descendants that lose their parent become children of the shim, so that
  // none is left when the instance ends.
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  for (auto number : {SIGHUP, SIGINT, SIGPIPE, SIGXFSZ})
    ::signal(number, SIG_IGN);
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

int start_failed(const options& o) {
  return complain("start", o.command[0]);
}

child_end end_of(const supervision& x) {
  return {x.wait_status, x.fenced, x.terminated, read_memory(x.cgroups)};
}

int code_of(const supervision& x) {
  return WIFSIGNALED(x.wait_status) ? 128 + WTERMSIG(x.wait_status)
                                    : WEXITSTATUS(x.wait_status);
}

/// Negative, with errno set, where nobody holds the other end.
int open_lifeline(const char* path) {
  if (path == nullptr)
    return ::fcntl(lifeline_place, F_GETFD) < 0 ? -1 : lifeline_place;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path, sizeof(address.sun_path) - 1);
  const auto result = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* where = reinterpret_cast<const sockaddr*>(&address);
  return result < 0 || ::connect(result, where, sizeof(address)) == 0 ? result
                                                                      : -1;
}

/// Beside an instance, whose cgroups are not to be emptied.
int run_attached(const options& o, supervision& x) {
  x.cgroups = {};
  x.lifeline = open_lifeline(o.lifeline);
  if (x.lifeline < 0)
    return complain("hold on to its",
                    o.lifeline != nullptr ? o.lifeline : "lifeline");
  // An engine has made the terminal the shim's: it is to be the command's.
  if (o.attached == attachment::terminal)
    ::ioctl(STDIN_FILENO, TIOCNOTTY);
  x.child = start_child(o, -1);
  if (x.child < 0)
    return start_failed(o);
  supervise(x);
  return code_of(x);
}

/// The first process of a container.
int run_plain(const options& o, supervision& x) {
  exit_record record{o.exit_file};
  if (!record.is_open())
    return complain("open", o.exit_file);
  x.child = start_child(o, -1);
  if (x.child < 0)
    return start_failed(o);
  supervise(x);
  // The engine tells the exit code all the same.
  auto end = end_of(x);
  // Not each engine tells it: Podman 4.3 does not with cgroups of version 1.
  end.memory = read_own_memory();
  record.write(end, nullptr);
  return code_of(x);
}

int run_recorded(const options& o, supervision& x) {
  auto directory = open_directory(o.directory);
  if (directory < 0)
    return complain("open", o.directory);
  int pipe[2] = {-1, -1};
  if (::pipe2(pipe, O_CLOEXEC) != 0)
    return complain("make", "pipes");
  ::fcntl(pipe[0], F_SETFL, O_NONBLOCK);
  exit_record record{directory};
  log_files log{directory, o.log_bytes};
  x.child = start_child(o, pipe[1]);
  if (x.child < 0)
    return start_failed(o);
  ::close(pipe[1]);
  if (!write_pid(directory, x.child)) {
    auto result = complain("write pid in", o.directory);
    kill_leftovers(x.cgroups, x.signals);
    return result;
  }
  release_standard_streams();
  x.output = pipe[0];
  x.log = &log;
  supervise(x);
  return record.write(end_of(x), &log) ? 0 : 1;
}

int run(const options& o) {
  detach(o.attached != attachment::none && o.lifeline == nullptr);
  be_the_last_to_go();
  supervision x;
  x.signals = open_signals();
  if (x.signals < 0)
    return complain("take", "signals");
  fence limit;
  if (o.fence != nullptr && !limit.hold(o.fence))
    return complain("keep the fence", o.fence);
  x.limit = &limit;
  x.stop_signal = o.stop_signal;
  x.cgroups = o.cgroups;
  if (o.attached != attachment::none)
    return run_attached(o, x);
  return o.directory != nullptr ? run_recorded(o, x) : run_plain(o, x);
}

} // namespace

} // namespace roscell::shim

int main(int argc, char** argv) {
  roscell::shim::options o;
  return roscell::shim::read_options(argc, argv, o) ? roscell::shim::run(o) : 2;
}
