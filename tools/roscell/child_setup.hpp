#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>

namespace roscell::cli {

/// How a program is started from here: with signals as usual, whatever of them
/// is taken here.
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

  /// It finds nothing on its standard input.
  void read_nothing() {
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null",
                                     O_RDONLY, 0);
  }

  /// Ctrl-C at our terminal does not reach it.
  void leave_terminal() {
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSID);
  }

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

} // namespace roscell::cli
