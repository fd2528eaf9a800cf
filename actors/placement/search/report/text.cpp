#include "actors/placement/search/report/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace roscell::allocation {

namespace {

/// Nine decimals show every shortage, since less than 1e-9 is none.
constexpr int most_decimals = 9;

/// The largest double has 309 digits before the point.
constexpr std::size_t longest = 330;

/// The fewest decimals, from `least` on, that still tell the number apart.
std::string decimal(double number, int least) {
  std::array<char, longest> text{};
  for (int decimals = least;; ++decimals) {
    char* end = std::to_chars(text.data(), text.data() + text.size(), number,
                              std::chars_format::fixed, decimals)
                    .ptr;
    double read = 0;
    std::from_chars(text.data(), end, read);
    auto lost = std::abs(read - number);
    if (decimals == most_decimals
        || lost <= 1e-10 * std::max(1.0, std::abs(number)))
      return {text.data(), end};
  }
}

} // namespace

std::string cores(double amount) {
  return decimal(amount, 1);
}

std::string mebibytes(double amount) {
  return decimal(amount, 0);
}

std::string quoted(const std::string& word) {
  return "'" + word + "'";
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string sentence;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0)
      sentence += i + 1 == words.size() ? " and " : ", ";
    sentence += words[i];
  }
  return sentence;
}

} // namespace roscell::allocation
