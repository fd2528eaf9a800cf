#include "actors/edge/io/plain_text.hpp"

#include "actors/edge/limits.hpp"

#include <algorithm>
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

namespace {

/// As ASCII has them, whatever the locale.
bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
         || (c >= '0' && c <= '9');
}

bool is_name_part(char c) {
  return is_letter_or_digit(c) || c == '_' || c == '.' || c == '-';
}

} // namespace

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= limits::text::name_bytes
         && is_letter_or_digit(text.front())
         && std::all_of(text.begin(), text.end(), is_name_part);
}

bool is_uuid(std::string_view text) {
  return !text.empty() && text.size() <= limits::text::uuid_bytes
         && text.find_first_not_of("0123456789abcdefABCDEF-")
                == std::string_view::npos;
}

std::string_view take_until(std::string_view& text, char mark) {
  const auto end = text.find(mark);
  const auto result = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return result;
}

} // namespace roscell
