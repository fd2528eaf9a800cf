#include "tools/roscell/view/table/fit.hpp"

#include <algorithm>
#include <numeric>

namespace roscell::cli {

namespace {

constexpr size_t gap = 2;

size_t total(const std::vector<size_t>& widths) {
  size_t result = 0;
  for (const auto width : widths)
    if (width > 0)
      result += width + (result > 0 ? gap : 0);
  return result;
}

/// The columns that are there, those that matter least first.
std::vector<size_t> by_rank(const std::vector<column_request>& columns,
                            const std::vector<size_t>& widths) {
  std::vector<size_t> result;
  for (size_t i = columns.size(); i-- > 0;)
    if (widths[i] > 0)
      result.push_back(i);
  std::stable_sort(result.begin(), result.end(), [&](size_t x, size_t y) {
    return columns[x].rank > columns[y].rank;
  });
  return result;
}

/// Shortens as far as need be; false if that is not enough.
bool shorten(const std::vector<column_request>& columns, size_t width,
             bool those_that_stay, std::vector<size_t>& widths) {
  for (const auto i : by_rank(columns, widths)) {
    const auto now = total(widths);
    if (now <= width)
      return true;
    if (columns[i].rank > 0 || those_that_stay)
      widths[i] = std::max(std::min(columns[i].least, widths[i]),
                           widths[i] - std::min(widths[i], now - width));
  }
  return total(widths) <= width;
}

} // namespace

std::vector<size_t> fitted(const std::vector<column_request>& columns,
                           size_t width) {
  std::vector<size_t> natural;
  natural.reserve(columns.size());
  for (const auto& x : columns)
    natural.push_back(std::max<size_t>(1, x.natural));
  while (true) {
    auto widths = natural;
    if (shorten(columns, width, false, widths))
      return widths;
    const auto order = by_rank(columns, natural);
    if (order.empty() || columns[order.front()].rank == 0) {
      shorten(columns, width, true, widths);
      return widths;
    }
    natural[order.front()] = 0;
  }
}

} // namespace roscell::cli
