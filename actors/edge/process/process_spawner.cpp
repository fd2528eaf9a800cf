#include "actors/edge/process/process_spawner.hpp"

#include "actors/edge/process/process_identity.hpp"
#include "actors/edge/process/spawn_words.hpp"
#include "schemas/utf8.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace roscell {

namespace {

/// Most of what a program says of its failure.
constexpr size_t max_text_bytes = 2048;

edge_error failed(const program& what, const std::string& why) {
  return {error_code::engine_failed,
          "cannot start '" + what.path.string() + "': " + why,
          "check that the file is there and can be run by this user"};
}

/// What posix_spawn does in the child before the program.
class spawn_setup {
public:
  explicit spawn_setup(int output) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null",
                                       O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setflags(&attributes_,
                               POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }

  ~spawn_setup() {
    ::posix_spawnattr_destroy(&attributes_);
    ::posix_spawn_file_actions_destroy(&actions_);
  }

  spawn_setup(const spawn_setup&) = delete;
  spawn_setup& operator=(const spawn_setup&) = delete;

  /// Returns 0 or an error number.
  int run(const program& what, pid_t& pid) {
    spawn_words words{what};
    return ::posix_spawn(&pid, what.path.c_str(), &actions_, &attributes_,
                         words.arguments(), words.environment());
  }

private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

using deadline = std::chrono::steady_clock::time_point;

/// Waits until there is something to read. Returns false when time runs out.
bool await_input(int fd, deadline end) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    pollfd waited{fd, POLLIN, 0};
    const int wait_ms = std::max(0, static_cast<int>(left.count()));
    if (const int n = ::poll(&waited, 1, wait_ms); n >= 0)
      return n > 0;
  }
}

/// Reads until the other end is closed, and keeps so much of it. Returns false
/// when time runs out.
bool read_text(int fd, deadline end, size_t max_bytes, std::string& text) {
  while (await_input(fd, end)) {
    std::array<char, 4096> buffer;
    const auto n = ::read(fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return true;
    const auto room = max_bytes - text.size();
    text.append(buffer.data(), std::min(static_cast<size_t>(n), room));
  }
  return false;
}

/// The exit code of a child that has ended; 128 + n after signal n.
int exit_code(int pidfd) {
  siginfo_t info{};
  if (::waitid(P_PIDFD, static_cast<id_t>(pidfd), &info,
               WEXITED | WNOHANG | WNOWAIT)
      != 0)
    return 0;
  return info.si_code == CLD_EXITED ? info.si_status : 128 + info.si_status;
}

std::string trimmed(const std::string& text) {
  const auto end = text.find_last_not_of(" \n\r\t");
  return valid_utf8(text.substr(0, end == std::string::npos ? 0 : end + 1));
}

/// What hangs in the kernel does not even die of SIGKILL: after so much time
/// it is left to the end of this process, which nothing waits for.
constexpr std::chrono::seconds last_patience{1};

void kill_and_reap(int pidfd) {
  ::pidfd_send_signal(pidfd, SIGKILL, nullptr, 0);
  await_input(pidfd, std::chrono::steady_clock::now() + last_patience);
  siginfo_t info{};
  ::waitid(P_PIDFD, static_cast<id_t>(pidfd), &info, WEXITED | WNOHANG);
}

/// The same where there is no descriptor of it: its output is closed when it
/// ends.
void kill_and_reap(pid_t pid, int output) {
  ::kill(pid, SIGKILL);
  std::string unread;
  read_text(output, std::chrono::steady_clock::now() + last_patience, 0,
            unread);
  ::waitpid(pid, nullptr, WNOHANG);
}

/// A child whose standard output and error can be read.
struct speaking_child {
  spawned_program child;
  unique_fd output;
};

edge_result<speaking_child> start(const program& what) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return failed(what, std::strerror(errno));
  speaking_child result;
  result.output = unique_fd{ends[0]};
  unique_fd writing{ends[1]};
  pid_t pid = -1;
  if (const int error = spawn_setup{writing.get()}.run(what, pid); error != 0)
    return failed(what, std::strerror(error));
  // Nobody else reaps our child, so the number is still its own.
  result.child.pidfd = unique_fd{::pidfd_open(pid, 0)};
  if (!result.child.pidfd) {
    const std::string why = std::strerror(errno);
    writing.reset();
    kill_and_reap(pid, result.output.get());
    return failed(what, "pidfd_open: " + why + " (needs Linux 5.3)");
  }
  result.child.identity = identify(pid).value_or(process_identity{pid, 0});
  return result;
}

} // namespace

edge_result<spawned_program> spawn_program(const program& what,
                                           std::chrono::milliseconds limit) {
  auto started = start(what);
  if (auto* error = std::get_if<edge_error>(&started))
    return std::move(*error);
  auto& [child, output] = std::get<speaking_child>(started);
  const auto end = std::chrono::steady_clock::now() + limit;
  std::string text;
  if (!read_text(output.get(), end, max_text_bytes, text)) {
    kill_and_reap(child.pidfd.get());
    return failed(what, "it did not start in time");
  }
  if (text.empty())
    return std::move(child);
  // Files are closed before the end of a process can be seen.
  await_input(child.pidfd.get(), end);
  kill_and_reap(child.pidfd.get());
  return failed(what, trimmed(text));
}

edge_result<std::string> run_program(const program& what,
                                     std::chrono::milliseconds limit,
                                     size_t max_bytes) {
  auto started = start(what);
  if (auto* error = std::get_if<edge_error>(&started))
    return std::move(*error);
  auto& [child, output] = std::get<speaking_child>(started);
  const auto end = std::chrono::steady_clock::now() + limit;
  std::string text;
  const bool in_time = read_text(output.get(), end, max_bytes, text)
                       && await_input(child.pidfd.get(), end);
  const auto code = exit_code(child.pidfd.get());
  kill_and_reap(child.pidfd.get());
  const auto name = "'" + what.path.string() + "'";
  if (!in_time)
    return edge_error{error_code::timeout,
                      name + " did not end within "
                          + std::to_string(limit.count() / 1000) + " s",
                      ""};
  if (code != 0)
    return edge_error{error_code::engine_failed,
                      name + " ended with code " + std::to_string(code) + ": "
                          + trimmed(text.substr(0, max_text_bytes)),
                      ""};
  return text;
}

} // namespace roscell
