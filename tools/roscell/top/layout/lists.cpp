#include "tools/roscell/top/layout/lists.hpp"

#include "client/columns.hpp"

#include <algorithm>

namespace roscell::cli::top {

namespace {

constexpr size_t mark_width = 1; ///< Of the cursor, before a row.

/// It behind the mark of the cursor.
line marked(line x, bool has_mark, size_t width) {
  x.spans.insert(x.spans.begin(), {has_mark ? ">" : " ", look::plain});
  return cut(std::move(x), width);
}

line heading_line(const line& names, const list_style& style) {
  auto result = marked(names, style.focused, style.width);
  pad(result, style.width);
  for (auto& part : result.spans)
    part.how = look::heading;
  return result;
}

} // namespace

tables all_lists(const known_cell& known, int64_t now_unix_ms) {
  const view_style style{{}, now_unix_ms};
  return {nodes_table(known.cell, style),
          table_of(task_columns(), known.cell.tasks, style),
          table_of(instance_columns(), known.instances, style)};
}

table ordered(const table& all, const std::string& filter,
              const list_order& order) {
  table_options options;
  options.filter = filter;
  options.sort =
      (order.backwards ? "-" : "")
      + (order.column.empty() ? all.columns.front().name : order.column);
  return chosen(all, options);
}

std::vector<line> list_lines(table shown, const list_style& style) {
  if (style.height == 0)
    return {};
  const auto count = shown.rows.size();
  const auto sorted = column_of(shown, style.order.column).value_or(0);
  shown.columns.front().name += " " + std::to_string(count);
  shown.columns[sorted].name += style.order.backwards ? " v" : " ^";
  text_style how;
  how.width = std::max(style.width, mark_width + 1) - mark_width;
  how.bars = true;
  how.utf8 = style.utf8;
  auto lines = shown.lines(how);
  // The cursor stays in the middle where there is more on both sides.
  const auto room = style.height - 1;
  auto first = style.selected > room / 2 ? style.selected - room / 2 : 0;
  first = std::min(first, count > room ? count - room : 0);
  std::vector<line> result{heading_line(lines.front(), style)};
  for (size_t i = first; i < std::min(count, first + room); ++i) {
    const bool selected = style.focused && i == style.selected;
    result.push_back(marked(std::move(lines[i + 1]), selected, style.width));
    result.back().selected = selected;
  }
  return result;
}

} // namespace roscell::cli::top
