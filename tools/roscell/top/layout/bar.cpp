#include "tools/roscell/top/layout/bar.hpp"

#include <algorithm>
#include <cmath>

namespace roscell::cli::top {

namespace {

struct glyphs {
  const char* others;
  const char* reserved;
  const char* unused;
};

std::string repeated(const char* glyph, size_t count) {
  std::string result;
  for (size_t i = 0; i < count; ++i)
    result += glyph;
  return result;
}

/// Columns for a part, at least one for what is there at all.
size_t columns_of(double amount, double capacity, size_t width, size_t room) {
  if (!(amount > 0) || !(capacity > 0))
    return 0;
  const auto exact =
      std::min(1.0, amount / capacity) * static_cast<double>(width);
  const auto columns = static_cast<size_t>(std::lround(exact));
  return std::min(room, std::max<size_t>(1, columns));
}

} // namespace

std::vector<span> bar(const share& of, size_t width, bool utf8) {
  const auto shown = utf8 ? glyphs{"█", "▒", "·"} : glyphs{"#", "+", "."};
  const auto reserved = columns_of(of.reserved, of.capacity, width, width);
  const auto others =
      columns_of(of.others, of.capacity, width, width - reserved);
  return {{repeated(shown.others, others), look::others},
          {repeated(shown.reserved, reserved), look::reserved},
          {repeated(shown.unused, width - others - reserved), look::faint}};
}

} // namespace roscell::cli::top
