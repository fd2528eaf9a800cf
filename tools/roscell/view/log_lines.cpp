#include "tools/roscell/view/log_lines.hpp"

namespace roscell::cli {

std::string log_lines::add(std::string_view part) {
  std::string result;
  while (!part.empty()) {
    const auto newline = part.find('\n');
    const bool open = newline == std::string_view::npos;
    const auto line = part.substr(0, open ? part.size() : newline + 1);
    if (!in_line_)
      result += prefix_;
    result += line;
    in_line_ = open;
    part.remove_prefix(line.size());
  }
  return result;
}

} // namespace roscell::cli
