#include "tools/roscell/top/layout/line.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table.hpp"

namespace roscell::cli::top {

void put(line& to, const std::string& text, look how) {
  if (!text.empty())
    to.spans.push_back({printable(text), how});
}

void pad(line& to, size_t column) {
  const auto width = width_of(to);
  if (width < column)
    put(to, std::string(column - width, ' '));
}

size_t width_of(const line& x) {
  size_t width = 0;
  for (const auto& part : x.spans)
    width += display_width(part.text);
  return width;
}

line cut(line x, size_t width) {
  size_t used = 0;
  for (auto& part : x.spans) {
    part.text = shortened(part.text, width - used);
    used += display_width(part.text);
  }
  return x;
}

std::string text_of(const line& x) {
  std::string text;
  for (const auto& part : x.spans)
    text += part.text;
  return text;
}

look look_of_state(const std::string& word) {
  // One list of words says which states are good, for all that is printed.
  const auto colour = state_colour(word);
  return colour == "\x1b[32m"   ? look::good
         : colour == "\x1b[31m" ? look::bad
         : colour == "\x1b[33m" ? look::busy
                                : look::plain;
}

} // namespace roscell::cli::top
