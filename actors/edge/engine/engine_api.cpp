#include "actors/edge/engine/engine_api.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using version = std::pair<int, int>;

/// "1.41"; nothing for any other text.
std::optional<version> parse_version(std::string_view text) {
  const auto dot = text.find('.');
  if (dot == std::string_view::npos)
    return std::nullopt;
  version result;
  const auto read = [](std::string_view digits, int& into) {
    const auto* end = digits.data() + digits.size();
    const auto done = std::from_chars(digits.data(), end, into);
    return done.ec == std::errc{} && done.ptr == end && into >= 0;
  };
  return read(text.substr(0, dot), result.first)
                 && read(text.substr(dot + 1), result.second)
             ? std::optional{result}
             : std::nullopt;
}

} // namespace

std::string choose_api(std::string_view newest, std::string_view oldest) {
  const auto last = parse_version(newest);
  if (!last)
    return {};
  const auto first = parse_version(oldest).value_or(version{0, 0});
  const auto chosen =
      std::max(first, std::min(*parse_version(known_api), *last));
  return std::to_string(chosen.first) + '.' + std::to_string(chosen.second);
}

} // namespace roscell
