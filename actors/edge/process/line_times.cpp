#include "actors/edge/process/line_times.hpp"

#include <algorithm>
#include <cstddef>

namespace roscell {

std::vector<int64_t> line_times(std::string_view bytes, int64_t from,
                                const std::vector<time_note>& notes) {
  std::vector<int64_t> result;
  size_t next = 0;
  int64_t known = 0;
  for (size_t at = 0; at < bytes.size();) {
    const auto offset = from + static_cast<int64_t>(at);
    for (; next < notes.size() && notes[next].offset <= offset; ++next)
      known = std::max<int64_t>(0, notes[next].unix_ms);
    result.push_back(known);
    const auto end = bytes.find('\n', at);
    at = end == std::string_view::npos ? bytes.size() : end + 1;
  }
  return result;
}

size_t bytes_of_lines(std::string_view text, int64_t lines) {
  size_t result = 0;
  for (; lines > 0 && result < text.size(); --lines) {
    const auto newline = text.find('\n', result);
    if (newline == std::string_view::npos)
      return text.size();
    result = newline + 1;
  }
  return result;
}

size_t begin_of_last_lines(std::string_view text, int64_t lines) {
  auto at = text.size();
  if (at > 0 && text[at - 1] == '\n')
    --at;
  for (; lines > 0; --lines) {
    const auto newline = at == 0 ? text.npos : text.rfind('\n', at - 1);
    if (newline == text.npos)
      return 0;
    at = newline;
  }
  return std::min(at + 1, text.size());
}

} // namespace roscell
