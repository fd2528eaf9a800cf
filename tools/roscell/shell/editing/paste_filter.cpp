#include "tools/roscell/shell/editing/paste_filter.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::string_view paste_begin = "\x1b[200~";
constexpr std::string_view paste_end = "\x1b[201~";

/// Bytes at the end of `text` that may be the beginning of `mark`.
size_t begun_mark(std::string_view text, std::string_view mark) {
  for (size_t n = std::min(text.size(), mark.size() - 1); n > 0; --n)
    if (text.substr(text.size() - n) == mark.substr(0, n))
      return n;
  return 0;
}

} // namespace

std::string paste_filter::add(std::string_view bytes) {
  auto text = std::exchange(kept_, {}) + std::string{bytes};
  std::string result;
  while (true) {
    const auto mark = pasting_ ? paste_end : paste_begin;
    const auto found = text.find(mark);
    auto part = text.substr(0, found);
    if (found == text.npos) {
      const auto n = begun_mark(part, mark);
      kept_ = part.substr(part.size() - n);
      part.resize(part.size() - n);
    }
    if (pasting_)
      std::replace(part.begin(), part.end(), '\t', ' ');
    result += part;
    if (found == text.npos)
      return result;
    text.erase(0, found + mark.size());
    pasting_ = !pasting_;
  }
}

} // namespace roscell::cli
