#pragma once

#include <csignal>
#include <optional>

namespace roscell::cli::top {

/// Takes the signals that a full screen has to answer, without handlers: the
/// size has changed, Ctrl-Z and its end, and those that end a program. Ctrl-Z
/// means nothing where it was ignored before, as in `roscell shell`. To be made
/// before any thread is, so that all of them leave the signals to it.
class terminal_signals {
public:
  terminal_signals();
  ~terminal_signals();

  terminal_signals(const terminal_signals&) = delete;
  terminal_signals& operator=(const terminal_signals&) = delete;

  /// Readable while a signal waits.
  int fd() const {
    return fd_;
  }

  /// The next one that waits.
  std::optional<int> take();

  /// Stops this process, as Ctrl-Z does without us. Returns when it goes on.
  void stop_here();

private:
  sigset_t before_{};
  int fd_;
};

/// While it lives, a crash of this process puts the terminal back as it was
/// when this was made, before it ends the process as it would have anyway. To
/// be made before a screen is opened, which tells it how that is left.
class crash_guard {
public:
  crash_guard();
  ~crash_guard();

  crash_guard(const crash_guard&) = delete;
  crash_guard& operator=(const crash_guard&) = delete;

  /// What terminals of this kind are told at the end of a full screen, as the
  /// terminal database has it.
  static void remember_farewell(const char* text);
};

} // namespace roscell::cli::top
