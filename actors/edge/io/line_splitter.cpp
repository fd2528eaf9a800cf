#include "actors/edge/io/line_splitter.hpp"

#include <utility>

namespace roscell {

line_splitter::line_splitter(size_t max_line_bytes, receiver on_line)
    : max_line_bytes_(max_line_bytes), on_line_(std::move(on_line)) {
  // nop
}

bool line_splitter::take(std::string_view bytes) {
  rest_ += bytes;
  size_t begin = 0;
  for (auto end = rest_.find('\n'); end != std::string::npos;
       end = rest_.find('\n', begin)) {
    if (!pass(std::string_view{rest_}.substr(begin, end - begin)))
      return false;
    begin = end + 1;
  }
  rest_.erase(0, begin);
  return true;
}

void line_splitter::finish() {
  if (!rest_.empty())
    pass(std::exchange(rest_, {}));
}

bool line_splitter::pass(std::string_view line) {
  if (!line.empty() && line.back() == '\r')
    line.remove_suffix(1);
  return on_line_(line);
}

} // namespace roscell
