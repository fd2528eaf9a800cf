#include "tools/roscell/exec/raw_terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

namespace roscell::cli {

raw_terminal::raw_terminal() {
  if (::tcgetattr(STDIN_FILENO, &before_) != 0)
    return;
  auto raw = before_;
  ::cfmakeraw(&raw);
  changed_ = ::tcsetattr(STDIN_FILENO, TCSADRAIN, &raw) == 0;
}

raw_terminal::~raw_terminal() {
  if (changed_)
    ::tcsetattr(STDIN_FILENO, TCSADRAIN, &before_);
}

terminal_size size_of_terminal() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0)
    return {};
  return {size.ws_col, size.ws_row};
}

} // namespace roscell::cli
