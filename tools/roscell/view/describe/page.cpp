#include "tools/roscell/view/describe/page.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

constexpr size_t value_column = 16;
constexpr size_t indent = 2;

} // namespace

void page::detail(const std::string& name, const std::string& value) {
  if (value.empty())
    return;
  const auto used = name.size() + 1;
  auto shown = printable(value);
  const auto colour = style_.colour ? state_colour(shown) : "";
  if (style_.width > value_column && !style_.tables.wide)
    shown = shortened(shown, style_.width - value_column);
  text_ += name + ":"
           + std::string(used < value_column ? value_column - used : 1, ' ')
           + colour + shown + (colour.empty() ? "" : "\x1b[0m") + "\n";
}

size_t page::inner_width(size_t width) {
  return width > indent ? width - indent : width;
}

void page::put(const std::string& heading, const std::string& lines) {
  text_ += "\n" + heading + ":\n";
  for (size_t at = 0; at < lines.size();) {
    const auto end = std::min(lines.find('\n', at), lines.size());
    text_ += std::string(indent, ' ') + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
}

void page::section(const std::string& heading, const table& rows) {
  auto inner = style_;
  inner.width = inner_width(style_.width);
  put(heading, rows.rows.empty() ? "none" : rows.render(inner));
}

void page::section(const std::string& heading, const std::string& lines) {
  if (!lines.empty())
    put(heading, lines);
}

} // namespace roscell::cli
