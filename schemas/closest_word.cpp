#include "schemas/closest_word.hpp"

#include <algorithm>
#include <cstddef>

namespace roscell {

namespace {

/// Longer texts are not compared: the time grows with the product of lengths.
constexpr size_t max_compared = 64;

/// Levenshtein's distance, row by row.
size_t distance(std::string_view x, std::string_view y) {
  std::vector<size_t> row(y.size() + 1);
  for (size_t j = 0; j <= y.size(); ++j)
    row[j] = j;
  for (size_t i = 1; i <= x.size(); ++i) {
    auto diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= y.size(); ++j) {
      auto replaced = diagonal + (x[i - 1] == y[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

} // namespace

std::string_view closest_word(std::string_view typed,
                              const std::vector<std::string_view>& words) {
  std::string_view result;
  if (typed.size() > max_compared)
    return result;
  auto best = max_compared;
  for (auto word : words) {
    auto d = distance(typed, word);
    if (d < best && d * 3 <= word.size()) {
      best = d;
      result = word;
    }
  }
  return result;
}

} // namespace roscell
