#include "tools/roscell/top/terminal/crash_guard.hpp"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

namespace roscell::cli::top {

namespace {

constexpr std::array crashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

/// Read in a signal handler, which may use nothing that is made there.
termios modes_before{};
std::array<char, 256> farewell{};
size_t farewell_length = 0;

extern "C" void restore_and_crash(int signal) {
  tcsetattr(STDIN_FILENO, TCSANOW, &modes_before);
  [[maybe_unused]] const auto written =
      write(STDOUT_FILENO, farewell.data(), farewell_length);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

} // namespace

crash_guard::crash_guard() {
  tcgetattr(STDIN_FILENO, &modes_before);
  for (const auto x : crashes)
    std::signal(x, restore_and_crash);
}

crash_guard::~crash_guard() {
  for (const auto x : crashes)
    std::signal(x, SIG_DFL);
}

void crash_guard::remember_farewell(const char* text) {
  const auto length = std::strlen(text);
  if (farewell_length + length > farewell.size())
    return;
  std::memcpy(farewell.data() + farewell_length, text, length);
  farewell_length += length;
}

} // namespace roscell::cli::top
