#include "tools/compare_poses/live_text.hpp"

#include <poll.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace roscell::comparison {

namespace {

/// Bytes of UTF-8 that begin no character.
bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80;
}

std::string cut(const std::string& line, std::size_t columns) {
  std::size_t end = 0;
  for (std::size_t seen = 0; end < line.size(); ++end)
    if (!continues(line[end]) && ++seen > columns)
      break;
  return line.substr(0, end);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);)
    result.push_back(line);
  return result;
}

} // namespace

std::optional<screen_size> stdout_screen() {
  if (::isatty(STDOUT_FILENO) == 0)
    return std::nullopt;
  winsize size{};
  // A terminal that does not tell its size is taken for the usual one.
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0
      || size.ws_row == 0)
    return screen_size{};
  return screen_size{size.ws_col, size.ws_row};
}

std::string fitted(const std::string& text, const screen_size& screen) {
  auto lines = lines_of(text);
  const auto room = std::max<std::size_t>(screen.rows, 2) - 1;
  if (lines.size() > room) {
    const auto left_out = lines.size() - room + 1;
    lines.resize(room - 1);
    lines.push_back("... and " + std::to_string(left_out) + " more lines");
  }
  std::string result;
  for (const auto& line : lines)
    result += cut(line, screen.columns) + "\n";
  return result;
}

std::string live_text::repainted(const std::string& text,
                                 const screen_size& screen) {
  std::string result;
  // A screen that was made smaller has lost its upper lines.
  if (const auto up = std::min(lines_, screen.rows - 1); up > 0)
    result = "\x1b[" + std::to_string(up) + "A";
  result += "\r\x1b[J" + fitted(text, screen);
  lines_ =
      static_cast<std::size_t>(std::count(result.begin(), result.end(), '\n'));
  return result;
}

namespace {

/// Throws std::runtime_error.
void watch_folder(int fd, const std::string& folder) {
  constexpr auto growing = IN_MODIFY | IN_CREATE | IN_MOVED_TO;
  if (::inotify_add_watch(fd, folder.c_str(), growing) < 0)
    throw std::runtime_error("cannot watch '" + folder
                             + "': " + std::strerror(errno));
}

} // namespace

file_watch::file_watch(const std::vector<std::string>& paths)
    : fd_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  try {
    for (const auto& path : paths)
      watch_folder(fd_, std::filesystem::absolute(path).parent_path());
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

file_watch::~file_watch() {
  ::close(fd_);
}

bool file_watch::wait_until(clock::time_point deadline) const {
  using namespace std::chrono;
  auto left = duration_cast<milliseconds>(deadline - clock::now()).count();
  // Longer than anybody waits, and short enough for poll.
  constexpr std::int64_t most_ms = 3'600'000;
  pollfd waited{fd_, POLLIN, 0};
  auto limit_ms = static_cast<int>(std::clamp<std::int64_t>(left, 0, most_ms));
  if (::poll(&waited, 1, limit_ms) < 1)
    return false;
  char events[8192];
  while (::read(fd_, events, sizeof(events)) > 0) {
    // Which file it was does not matter.
  }
  return true;
}

} // namespace roscell::comparison
