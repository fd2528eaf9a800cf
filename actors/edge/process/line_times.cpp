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

} // namespace roscell
