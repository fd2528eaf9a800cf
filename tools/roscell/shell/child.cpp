#include "tools/roscell/shell/child.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "tools/roscell/child_setup.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

constexpr int by_signal = 128;

/// Waits for its end. What is to end this process ends the child before.
void await_child(pid_t child) {
  sigset_t ending{};
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGHUP);
  const unique_fd ended{pidfd_open(child, 0)};
  const unique_fd asked{signalfd(-1, &ending, SFD_CLOEXEC | SFD_NONBLOCK)};
  std::array<pollfd, 2> fds{
      {{ended.get(), POLLIN, 0}, {asked.get(), POLLIN, 0}}};
  int last = 0;
  while (ended && fds[0].revents == 0) {
    poll(fds.data(), fds.size(), -1);
    signalfd_siginfo taken{};
    if (::read(asked.get(), &taken, sizeof taken) == sizeof taken) {
      last = static_cast<int>(taken.ssi_signo);
      kill(child, last);
    }
  }
  // It is still meant for us.
  if (last != 0)
    std::raise(last);
}

int end_of_child(pid_t child) {
  await_child(child);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    // A signal that the shell takes itself is no end.
  }
  return WIFSIGNALED(status) ? by_signal + WTERMSIG(status)
                             : WEXITSTATUS(status);
}

/// This very program with these words.
int start_and_wait(const child_setup& setup, std::vector<std::string> words) {
  words.insert(words.begin(), "roscell");
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& x : words)
    arguments.push_back(x.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int problem = posix_spawn(&child, "/proc/self/exe", &setup.files,
                                  &setup.attributes, arguments.data(), environ);
  if (problem != 0)
    throw command_error{exit_refused, std::string{"cannot start a process: "}
                                          + std::strerror(problem)};
  return end_of_child(child);
}

/// Options that name the node of the shell.
std::vector<std::string> connection_arguments(const connection_options& to) {
  std::vector<std::string> words;
  if (!to.to.empty())
    words = {"--to", to.to};
  if (!to.token_file.empty())
    words.insert(words.end(), {"--token-file", to.token_file.string()});
  return words;
}

/// Unlike a pipe, a file in memory takes all of it before somebody reads.
unique_fd file_of(const std::string& text) {
  unique_fd file{memfd_create("request", MFD_CLOEXEC)};
  const auto size = static_cast<ssize_t>(text.size());
  if (!file || write(file.get(), text.data(), text.size()) != size
      || lseek(file.get(), 0, SEEK_SET) != 0)
    throw command_error{exit_refused, std::string{"cannot keep the request: "}
                                          + std::strerror(errno)};
  return file;
}

} // namespace

int run_child(const connection_options& connection, const std::string& line,
              child_input input) {
  child_setup setup;
  if (input == child_input::nothing)
    setup.read_nothing();
  auto words = connection_arguments(connection);
  words.insert(words.begin(), "shell");
  words.insert(words.end(), {"-c", line});
  return start_and_wait(setup, std::move(words));
}

int send_by_child(const connection_options& connection,
                  const json_collector& request) {
  if (const auto wrong = request.errors(); !wrong.empty()) {
    print_text(wrong);
    print_note("nothing is sent");
    return exit_refused;
  }
  const auto file = file_of(request.text());
  child_setup setup;
  posix_spawn_file_actions_adddup2(&setup.files, file.get(), STDIN_FILENO);
  auto words = connection_arguments(connection);
  words.insert(words.begin(), {"request", "-"});
  return start_and_wait(setup, std::move(words));
}

} // namespace roscell::cli
