#include "actors/allocation/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

namespace roscell::allocation {

namespace {

/// Nine decimals show every shortage, since less than 1e-9 is none.
constexpr int most_decimals = 9;

/// The fewest decimals, from `least` on, that still tell the number apart.
std::string decimal(double number, int least) {
  for (int decimals = least;; ++decimals) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(decimals) << number;
    auto lost = std::abs(std::strtod(out.str().c_str(), nullptr) - number);
    if (decimals == most_decimals
        || lost <= 1e-10 * std::max(1.0, std::abs(number)))
      return out.str();
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
