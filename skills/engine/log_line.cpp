#include "roscell/skill/log_line.hpp"

#include <unistd.h>

#include <algorithm>

namespace roscell::engine {

void log_line(std::string line) {
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; },
      '?');
  line += '\n';
  [[maybe_unused]] auto n = ::write(STDERR_FILENO, line.data(), line.size());
}

} // namespace roscell::engine
