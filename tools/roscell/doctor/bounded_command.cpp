#include "tools/roscell/doctor/bounded_command.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/pidfd.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <optional>

namespace roscell::cli {

namespace {

using command_clock = std::chrono::steady_clock;

/// A ruleset of ten thousand rules takes less.
constexpr size_t most_said_bytes = 16UL << 20;

/// The process id; 0: it could not be started.
pid_t start_command(const std::vector<std::string>& words, int output) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const auto& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY,
                                   0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  pid_t pid = 0;
  const auto error = posix_spawnp(&pid, arguments.front(), &files, nullptr,
                                  arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? pid : 0;
}

/// What is written there until its end. False if that did not come in time.
bool read_until(int fd, command_clock::time_point deadline, std::string& said) {
  std::array<char, 65536> buffer{};
  while (said.size() < most_said_bytes) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - command_clock::now());
    pollfd wanted{fd, POLLIN, 0};
    if (left.count() <= 0
        || poll(&wanted, 1, static_cast<int>(left.count())) <= 0)
      return false;
    const auto n = read(fd, buffer.data(), buffer.size());
    if (n <= 0)
      return n == 0;
    said.append(buffer.data(), static_cast<size_t>(n));
  }
  return false;
}

/// How it has ended, as `waitpid` tells; none: it has not by then. What hangs
/// in the kernel does not even die of SIGKILL.
std::optional<int> await_end(pid_t pid, command_clock::time_point deadline) {
  const unique_fd process{pidfd_open(pid, 0)};
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
      deadline - command_clock::now());
  pollfd wanted{process.get(), POLLIN, 0};
  if (process && left.count() > 0)
    poll(&wanted, 1, static_cast<int>(left.count()));
  int status = 0;
  if (waitpid(pid, &status, WNOHANG) != pid)
    return std::nullopt;
  return status;
}

/// It is left to the end of this program where it does not go.
void end_by_force(pid_t pid) {
  constexpr std::chrono::milliseconds patience{1000};
  kill(pid, SIGKILL);
  await_end(pid, command_clock::now() + patience);
}

} // namespace

command_result run_bounded(const std::vector<std::string>& words,
                           std::chrono::milliseconds limit) {
  const auto deadline = command_clock::now() + limit;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    return {command_not_found, {}};
  const unique_fd reading{ends[0]};
  unique_fd writing{ends[1]};
  const auto pid = start_command(words, writing.get());
  writing.reset();
  if (pid == 0)
    return {command_not_found, {}};
  command_result result;
  const bool is_silent = read_until(reading.get(), deadline, result.said);
  // One that closes its output may go on for ever.
  const auto status = is_silent ? await_end(pid, deadline) : std::nullopt;
  if (!status)
    end_by_force(pid);
  result.code = status && WIFEXITED(*status) ? WEXITSTATUS(*status)
                                             : command_took_too_long;
  return result;
}

} // namespace roscell::cli
