#include "tools/roscell/view/describe/page.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

constexpr size_t indent = 2;

} // namespace

void page::put_name(const std::string& name) {
  const auto begin = name + (name.empty() ? "" : mark_);
  text_ +=
      begin
      + std::string(std::max(column_, begin.size() + 1) - begin.size(), ' ');
}

void page::detail(const std::string& name, const std::string& value) {
  if (value.empty())
    return;
  auto shown = printable(value);
  const auto how = look_of_state(shown);
  if (style_.width > column_ && !style_.tables.wide)
    shown = shortened(shown, style_.width - column_);
  line x;
  cli::put(x, shown, how);
  put_name(name);
  text_ += text_of(x, style_.colour) + "\n";
}

void page::sentence(const std::string& name, const std::string& text) {
  const auto width = style_.width > 40 ? style_.width - column_ : text.npos;
  auto rest = printable(text);
  for (auto key = name; !rest.empty(); key.clear()) {
    auto end = rest.size() <= width ? rest.size() : rest.rfind(' ', width);
    end = std::min(end, rest.size());
    put_name(key);
    text_ += rest.substr(0, end) + "\n";
    rest.erase(0, std::min(end + 1, rest.size()));
  }
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
