#include "actors/edge/exec/attached_program.hpp"

#include "actors/edge/process/spawn_words.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// Where the program has its end of the lifeline (tools/instance_shim).
constexpr int lifeline_place = 3;

edge_error not_attached(const std::string& what) {
  return {error_code::engine_failed,
          "cannot " + what + ": " + std::strerror(errno),
          "does this host run short of processes, files or terminals?"};
}

/// The program's ends, which are closed here once it has them.
struct program_ends {
  unique_fd input;
  unique_fd output;
  unique_fd errors;
  unique_fd lifeline;
};

struct both_ends {
  attached_program ours;
  program_ends theirs;
};

bool make_pipe(unique_fd& reading, unique_fd& writing, unique_fd& ours) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return false;
  reading = unique_fd{ends[0]};
  writing = unique_fd{ends[1]};
  return ::fcntl(ours.get(), F_SETFL, O_NONBLOCK) == 0;
}

unique_fd copy_of(const unique_fd& fd) {
  return unique_fd{::fcntl(fd.get(), F_DUPFD_CLOEXEC, lifeline_place + 1)};
}

bool make_terminal(both_ends& x, terminal_size size) {
  auto& [ours, theirs] = x;
  ours.input = unique_fd{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  std::array<char, 128> name;
  if (!ours.input || ::grantpt(ours.input.get()) != 0
      || ::unlockpt(ours.input.get()) != 0
      || ::ptsname_r(ours.input.get(), name.data(), name.size()) != 0
      || ::fcntl(ours.input.get(), F_SETFL, O_RDWR | O_NONBLOCK) != 0)
    return false;
  resize_terminal(ours.input.get(), size);
  theirs.input = unique_fd{::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
  ours.output = copy_of(ours.input);
  theirs.output = copy_of(theirs.input);
  theirs.errors = copy_of(theirs.input);
  return ours.output && theirs.input && theirs.output && theirs.errors;
}

bool make_pipes(both_ends& x) {
  auto& [ours, theirs] = x;
  return make_pipe(theirs.input, ours.input, ours.input)
         && make_pipe(ours.output, theirs.output, ours.output)
         && make_pipe(ours.errors, theirs.errors, ours.errors);
}

/// As far as we may: without it the program can use them all the same.
void give_to(uid_t user, const program_ends& ends) {
  for (const auto* end : {&ends.input, &ends.output, &ends.errors})
    [[maybe_unused]] const int ignored =
        ::fchown(end->get(), user, static_cast<gid_t>(-1));
}

/// Returns 0 or an error number.
int run_with(const program& what, const program_ends& ends, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  int place = STDIN_FILENO;
  for (const auto* end :
       {&ends.input, &ends.output, &ends.errors, &ends.lifeline})
    ::posix_spawn_file_actions_adddup2(&actions, end->get(), place++);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, place);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK
                                              | POSIX_SPAWN_SETSIGDEF
                                              | POSIX_SPAWN_SETSID);
  spawn_words words{what};
  const int result =
      ::posix_spawn(&pid, what.path.c_str(), &actions, &attributes,
                    words.arguments(), words.environment());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  return result;
}

} // namespace

edge_result<attached_program>
spawn_attached(const program& what, const std::optional<terminal_size>& size,
               std::optional<uid_t> user) {
  both_ends x;
  if (!(size ? make_terminal(x, *size) : make_pipes(x)))
    return not_attached(size ? "make a terminal" : "make pipes");
  // The program's end of the lifeline is read, and nothing is ever written.
  if (!make_pipe(x.theirs.lifeline, x.ours.lifeline, x.ours.lifeline))
    return not_attached("make pipes");
  if (user)
    give_to(*user, x.theirs);
  pid_t pid = -1;
  errno = run_with(what, x.theirs, pid);
  if (errno != 0)
    return not_attached("start '" + what.path.string() + "'");
  // Nobody else reaps our child, so the number is still its own.
  x.ours.pidfd = unique_fd{::pidfd_open(pid, 0)};
  if (x.ours.pidfd)
    return std::move(x.ours);
  auto why = not_attached("watch '" + what.path.string() + "'");
  ::kill(pid, SIGKILL);
  return why;
}

void resize_terminal(int fd, terminal_size size) {
  winsize wanted{};
  wanted.ws_col = static_cast<unsigned short>(size.columns);
  wanted.ws_row = static_cast<unsigned short>(size.rows);
  if (size.columns > 0 && size.rows > 0)
    ::ioctl(fd, TIOCSWINSZ, &wanted);
}

} // namespace roscell
