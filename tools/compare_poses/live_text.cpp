#include "tools/compare_poses/live_text.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>
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

} // namespace roscell::comparison
