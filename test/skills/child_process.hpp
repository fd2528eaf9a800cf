#pragma once

#include "skills/engine/life/unique_fd.hpp"

#include "test/skills/files.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell::test {

/// Waits for the end of a process, which may be no child of this one.
inline bool wait_for_end(pid_t pid) {
  engine::unique_fd fd{static_cast<int>(::syscall(SYS_pidfd_open, pid, 0))};
  return !fd || wait_readable(fd.get());
}

/// A program that is killed when the test is over.
class child_process {
public:
  using variables = std::map<std::string, std::string>;

  /// Starts `arguments[0]` with just these variables. With `limit_file_bytes`
  /// the program and its children can write no larger files.
  child_process(std::vector<std::string> arguments,
                const variables& environment,
                std::optional<std::size_t> limit_file_bytes = {}) {
    std::vector<std::string> settings;
    for (const auto& [name, value] : environment)
      settings.emplace_back(name).append("=").append(value);
    auto argv = pointers(arguments);
    auto envp = pointers(settings);
    auto output = open_output();
    pid_ = ::fork();
    if (pid_ != 0)
      return;
    ::dup2(output.get(), STDOUT_FILENO);
    ::dup2(output.get(), STDERR_FILENO);
    if (limit_file_bytes) {
      rlimit limit{*limit_file_bytes, *limit_file_bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(126);
  }

  ~child_process() {
    if (reaped_)
      return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }

  child_process(const child_process&) = delete;
  child_process& operator=(const child_process&) = delete;

  pid_t pid() const {
    return pid_;
  }

  void signal(int number) const {
    ::kill(pid_, number);
  }

  /// Waits for the end. Returns the exit code, minus the number of the signal
  /// that killed it, or nothing when patience was exhausted.
  std::optional<int> wait() {
    if (!wait_for_end(pid_))
      return std::nullopt;
    auto status = 0;
    ::waitpid(pid_, &status, 0);
    reaped_ = true;
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }

  /// What it wrote to stdout and stderr. To be called after `wait`.
  std::string output() const {
    return content_of(folder_ / "output");
  }

private:
  /// The pointers that execve wants; valid as long as `texts` is.
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (auto& text : texts)
      result.push_back(text.data());
    result.push_back(nullptr);
    return result;
  }

  engine::unique_fd open_output() const {
    return engine::unique_fd{::open((folder_ / "output").c_str(),
                                    O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC,
                                    0600)};
  }

  temp_folder folder_;
  pid_t pid_ = -1;
  bool reaped_ = false;
};

} // namespace roscell::test
