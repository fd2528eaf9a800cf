#pragma once

#include "tools/roscell/exec/remote_command.hpp"

#include <csignal>
#include <functional>
#include <string_view>
#include <thread>

namespace roscell::cli {

/// How the streams of this process are those of a command elsewhere.
struct attachment_options {
  bool terminal = false; ///< Both are terminals.
  bool no_input = false; ///< It finds the end of its input at once.
};

/// Signals are left to `local_streams` by all threads from now on, until this
/// ends: to be made before any other thread.
class taken_signals {
public:
  taken_signals();
  ~taken_signals();

  taken_signals(const taken_signals&) = delete;
  taken_signals& operator=(const taken_signals&) = delete;

  int fd() const {
    return fd_;
  }

private:
  sigset_t before_{};
  int fd_ = -1;
};

/// Passes our standard input and the size of our terminal on to a command, and
/// ends this process, and the command, by the signals that end programs.
class local_streams {
public:
  local_streams(remote_command& command, const attachment_options& how,
                const taken_signals& signals,
                std::function<void()> restore_terminal);

  /// Waits until what is under way to the command is there, or cannot be.
  ~local_streams();

  local_streams(const local_streams&) = delete;
  local_streams& operator=(const local_streams&) = delete;

private:
  void pass_input();
  void watch_signals();
  void on_signal(int number);
  bool await(int fd) const;

  remote_command& command_;
  const attachment_options how_;
  const taken_signals& signals_;
  const std::function<void()> restore_terminal_;
  int stop_ = -1; ///< Readable when it is over.
  std::thread input_;
  std::thread watch_;
};

/// Writes all to a descriptor of ours, however slow its reader is, which the
/// command is told meanwhile. False: nobody reads it any more.
bool write_all(int fd, std::string_view bytes, const remote_command& command);

} // namespace roscell::cli
