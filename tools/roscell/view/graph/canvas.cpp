#include "tools/roscell/view/graph/canvas.hpp"

#include <algorithm>

namespace roscell::cli {

canvas::cell& canvas::at(size_t x, size_t y) {
  if (rows_.size() <= y)
    rows_.resize(y + 1);
  if (rows_[y].size() <= x)
    rows_[y].resize(x + 1);
  return rows_[y][x];
}

void canvas::line(size_t x1, size_t y1, size_t x2, size_t y2) {
  for (auto x = std::min(x1, x2); x < std::max(x1, x2); ++x) {
    at(x, y1).sides |= right;
    at(x + 1, y1).sides |= left;
  }
  for (auto y = std::min(y1, y2); y < std::max(y1, y2); ++y) {
    at(x2, y).sides |= down;
    at(x2, y + 1).sides |= up;
  }
}

void canvas::frame(size_t left_x, size_t top, size_t right_x, size_t bottom) {
  line(left_x, top, right_x, top);
  line(left_x, bottom, right_x, bottom);
  line(left_x, top, left_x, bottom);
  line(right_x, top, right_x, bottom);
}

void canvas::text(size_t x, size_t y, std::string_view words) {
  while (!words.empty()) {
    size_t size = 1;
    while (size < words.size()
           && (static_cast<unsigned char>(words[size]) & 0xc0) == 0x80)
      ++size;
    at(x++, y).letter = words.substr(0, size);
    words.remove_prefix(size);
  }
}

std::string canvas::str() const {
  // Which line goes to which sides: the index is a sum of `side`s.
  static constexpr std::string_view lines[] = {" ", "│", "│", "│", "─", "┘",
                                               "┐", "┤", "─", "└", "┌", "├",
                                               "─", "┴", "┬", "┼"};
  std::string result;
  for (const auto& row : rows_) {
    std::string line;
    for (const auto& x : row)
      line += x.letter.empty() ? std::string{lines[x.sides]} : x.letter;
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + "\n";
  }
  return result;
}

} // namespace roscell::cli
