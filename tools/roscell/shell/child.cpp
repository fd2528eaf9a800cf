#include "tools/roscell/shell/child.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

constexpr int by_signal = 128;

/// How a child is started: with this standard input, and signals as usual.
class child_setup {
public:
  child_setup() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    sigset_t none{};
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  }

  ~child_setup() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }

  child_setup(const child_setup&) = delete;
  child_setup& operator=(const child_setup&) = delete;

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

int end_of_child(pid_t child) {
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
std::vector<std::string> connection_words(const connection_options& to) {
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
    posix_spawn_file_actions_addopen(&setup.files, STDIN_FILENO, "/dev/null",
                                     O_RDONLY, 0);
  auto words = connection_words(connection);
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
  auto words = connection_words(connection);
  words.insert(words.begin(), {"request", "-"});
  return start_and_wait(setup, std::move(words));
}

} // namespace roscell::cli
