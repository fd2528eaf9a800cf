#include "tools/roscell/secrets/secret_value.hpp"

#include "actors/edge/disk/limits.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>

namespace roscell::cli {

namespace {

volatile std::sig_atomic_t last_signal = 0;

void note_signal(int number) {
  last_signal = number;
}

/// The terminal shows nothing of what is typed, until this ends, also by a
/// signal: that ends the reading first, and this process after it.
class hidden_typing {
public:
  hidden_typing() {
    last_signal = 0;
    struct sigaction noting {};
    noting.sa_handler = note_signal;
    for (size_t i = 0; i < ending.size(); ++i)
      ::sigaction(ending[i], &noting, &before_[i]);
    struct sigaction ignoring {};
    ignoring.sa_handler = SIG_IGN;
    ::sigaction(SIGTSTP, &ignoring, &stop_before_);
    if (::tcgetattr(STDIN_FILENO, &terminal_) != 0)
      return;
    auto quiet = terminal_;
    quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    changed_ = ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &quiet) == 0;
  }

  ~hidden_typing() {
    if (changed_)
      ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &terminal_);
    for (size_t i = 0; i < ending.size(); ++i)
      ::sigaction(ending[i], &before_[i], nullptr);
    ::sigaction(SIGTSTP, &stop_before_, nullptr);
    if (last_signal != 0)
      ::raise(last_signal);
  }

  hidden_typing(const hidden_typing&) = delete;
  hidden_typing& operator=(const hidden_typing&) = delete;

private:
  static constexpr std::array<int, 4> ending{SIGINT, SIGTERM, SIGHUP, SIGQUIT};

  std::array<struct sigaction, 4> before_{};
  struct sigaction stop_before_ {};
  termios terminal_{};
  bool changed_ = false;
};

/// A line without its end, or what came before a signal.
std::string read_line() {
  std::string result;
  char letter = 0;
  while (result.size() <= limits::secret::bytes) {
    const auto n = ::read(STDIN_FILENO, &letter, 1);
    if (n < 0 && errno == EINTR && last_signal == 0)
      continue;
    if (n <= 0 || letter == '\n')
      break;
    result += letter;
  }
  return result;
}

std::string ask_for(const std::string& question) {
  std::fputs(question.c_str(), stderr);
  std::fflush(stderr);
  const hidden_typing hidden;
  auto result = read_line();
  std::fputs("\n", stderr);
  return result;
}

std::string typed_value(const std::string& name) {
  auto first = ask_for("Value of '" + printable(name) + "': ");
  if (first.empty())
    return first;
  if (ask_for("The same once more: ") != first)
    throw command_error{exit_usage, "these two differ", "try it once more"};
  return first;
}

void drop_line_end(std::string& value) {
  if (!value.empty() && value.back() == '\n')
    value.pop_back();
}

} // namespace

std::string read_secret_value(const std::string& name,
                              const value_origin& from) {
  std::string value;
  if (!from.file.empty() && from.file != "-") {
    value = read_file(from.file, limits::secret::bytes);
  } else if (::isatty(STDIN_FILENO) != 0) {
    value = typed_value(name);
  } else {
    value = read_file("-", limits::secret::bytes + 1);
    if (!from.keep_newline)
      drop_line_end(value);
  }
  if (value.empty())
    throw command_error{exit_usage, "there is no value",
                        "`roscell secret remove` removes a secret"};
  if (value.size() > limits::secret::bytes)
    throw command_error{exit_usage, "a secret has at most "
                                        + std::to_string(limits::secret::bytes)
                                        + " bytes"};
  return value;
}

} // namespace roscell::cli
