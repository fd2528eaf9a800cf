#include "tools/roscell/client/read_file.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace roscell::cli {

namespace {

std::string read_all(int fd, const std::string& name, size_t max_bytes) {
  std::string text;
  std::array<char, 65536> buffer{};
  while (true) {
    const auto n = read(fd, buffer.data(), buffer.size());
    if (n == 0)
      return text;
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw command_error{exit_usage,
                          "cannot read " + name + ": " + std::strerror(errno)};
    text.append(buffer.data(), static_cast<size_t>(n));
    if (text.size() > max_bytes)
      throw command_error{exit_usage, name + " is larger than "
                                          + format_bytes(double(max_bytes))};
  }
}

/// Closes what it was given.
struct open_file {
  int fd;
  explicit open_file(const std::string& name)
      : fd{open(name.c_str(), O_RDONLY | O_CLOEXEC)} {}
  ~open_file() {
    if (fd >= 0)
      close(fd);
  }
  open_file(const open_file&) = delete;
  open_file& operator=(const open_file&) = delete;
};

} // namespace

std::string read_file(const std::string& name, size_t max_bytes) {
  if (name == "-") {
    if (isatty(STDIN_FILENO) == 1)
      print_note("reading the request from the terminal; Ctrl-D ends it");
    return read_all(STDIN_FILENO, "standard input", max_bytes);
  }
  const open_file file{name};
  if (file.fd < 0)
    throw command_error{exit_usage,
                        "cannot read " + name + ": " + std::strerror(errno)};
  return read_all(file.fd, name, max_bytes);
}

} // namespace roscell::cli
