#include "tools/roscell/view/span.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace roscell::cli {

std::chrono::seconds parse_span(std::string_view text) {
  constexpr int64_t day = 24 * 3600;
  constexpr int64_t longest = 36'500 * day;
  static constexpr std::pair<char, int64_t> units[] = {
      {'s', 1}, {'m', 60}, {'h', 3600}, {'d', day}};
  const auto refuse = [&]() -> std::chrono::seconds {
    throw std::invalid_argument{"'" + std::string{text}
                                + "' is no span such as 90s, 5m, 2h or 7d"};
  };
  const auto* unit =
      text.empty()
          ? std::end(units)
          : std::find_if(std::begin(units), std::end(units),
                         [&](const auto& x) { return x.first == text.back(); });
  if (unit == std::end(units))
    return refuse();
  int64_t count = 0;
  const auto* end = text.data() + text.size() - 1;
  const auto [rest, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc{} || rest != end || count < 0
      || count > longest / unit->second)
    return refuse();
  return std::chrono::seconds{count * unit->second};
}

} // namespace roscell::cli
