#include "tools/roscell/view/graph/drawing.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

namespace {

/// Where something flows at the left of the boxes.
struct lane {
  size_t top = 0; ///< The first and the last line that it leads to.
  size_t bottom = 0;
  size_t column = 0;
};

using lanes_by_key = std::map<std::string, lane>;

/// All lines of a drawing, those of frames without a key.
std::vector<drawn_line>
lines_with_frames(const std::vector<std::vector<drawn_line>>& boxes) {
  std::vector<drawn_line> result;
  for (const auto& box : boxes) {
    result.push_back({});
    result.insert(result.end(), box.begin(), box.end());
    result.push_back({});
  }
  return result;
}

lanes_by_key lanes_of(const std::vector<drawn_line>& lines) {
  lanes_by_key result;
  for (size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].key.empty())
      result.try_emplace(lines[i].key, lane{i, i, 0}).first->second.bottom = i;
  for (auto i = result.begin(); i != result.end();)
    i = i->second.top == i->second.bottom ? result.erase(i) : std::next(i);
  return result;
}

/// Gives each lane a column of its own beside others. Returns how many there
/// are.
size_t place_lanes(lanes_by_key& lanes) {
  std::vector<lane*> order;
  for (auto& [key, x] : lanes)
    order.push_back(&x);
  std::sort(order.begin(), order.end(),
            [](const lane* x, const lane* y) { return x->top < y->top; });
  std::vector<size_t> free_from; // Of each column, the line.
  for (auto* x : order) {
    const auto found =
        std::find_if(free_from.begin(), free_from.end(),
                     [&](size_t line) { return line <= x->top; });
    x->column = static_cast<size_t>(found - free_from.begin());
    if (found == free_from.end())
      free_from.push_back(0);
    free_from[x->column] = x->bottom + 1;
  }
  return free_from.size();
}

/// What stands at the left of a line; one lane passes below another.
std::string margin_of(const lanes_by_key& lanes, size_t columns, size_t number,
                      const drawn_line& line) {
  std::vector<std::string> cells(2 * columns, " ");
  for (const auto& [key, x] : lanes)
    if (number >= x.top && number <= x.bottom)
      cells[2 * x.column] = "│";
  if (const auto own = lanes.find(line.key); own != lanes.end()) {
    const auto& x = own->second;
    cells[2 * x.column] = number == x.top      ? "┌"
                          : number == x.bottom ? "└"
                                               : "├";
    std::replace(cells.begin() + static_cast<long>(2 * x.column), cells.end(),
                 std::string{" "}, std::string{"─"});
    if (line.comes_in)
      cells.back() = "▶";
  }
  return joined(cells, "");
}

std::string horizontal(size_t width) {
  std::string result;
  for (size_t i = 0; i < width; ++i)
    result += "─";
  return result;
}

/// The lines of a box in its frame, no longer than `width`.
std::vector<std::string> framed(const std::vector<drawn_line>& box,
                                size_t width) {
  size_t inner = 0;
  for (const auto& x : box)
    inner = std::max(inner, display_width(x.text));
  inner = std::min(inner, width - std::min<size_t>(width, 4));
  std::vector<std::string> result{"┌" + horizontal(inner + 2) + "┐"};
  for (const auto& x : box) {
    const auto text = shortened(x.text, inner);
    result.push_back("│ " + text + std::string(inner - display_width(text), ' ')
                     + " │");
  }
  result.push_back("└" + horizontal(inner + 2) + "┘");
  return result;
}

} // namespace

std::string drawing(const std::vector<std::vector<drawn_line>>& boxes,
                    size_t width) {
  const auto lines = lines_with_frames(boxes);
  auto lanes = lanes_of(lines);
  const auto columns = place_lanes(lanes);
  std::string result;
  size_t number = 0;
  for (const auto& box : boxes)
    for (const auto& text : framed(box, width - std::min(width, 2 * columns))) {
      result +=
          shortened(margin_of(lanes, columns, number, lines[number]) + text,
                    width)
          + "\n";
      ++number;
    }
  return result;
}

} // namespace roscell::cli
