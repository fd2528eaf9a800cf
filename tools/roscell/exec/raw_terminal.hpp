#pragma once

#include "actors/edge/exec/exec_channel.hpp"
#include "tools/roscell/top/terminal/signals.hpp"

#include <termios.h>

namespace roscell::cli {

/// The terminal at standard input passes on every key as it is typed, Ctrl-C
/// too, until this ends. A crash of this process leaves it as it was as well.
class raw_terminal {
public:
  raw_terminal();
  ~raw_terminal();

  raw_terminal(const raw_terminal&) = delete;
  raw_terminal& operator=(const raw_terminal&) = delete;

private:
  top::crash_guard guard_;
  termios before_{};
  bool changed_ = false;
};

/// Of the terminal at standard output; zeros: it is none.
terminal_size size_of_terminal();

} // namespace roscell::cli
