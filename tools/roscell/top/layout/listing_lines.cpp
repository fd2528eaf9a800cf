#include "tools/roscell/top/layout/listing_lines.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table/fit.hpp"

#include <algorithm>

namespace roscell::cli::top {

namespace {

constexpr size_t gap = 2;
constexpr size_t mark_width = 1; ///< Of the cursor, before a row.
constexpr size_t least_bar = 7;
constexpr size_t longest_bar = 30;
constexpr size_t least_text = 8;
constexpr int empty_column_rank = 50;

/// "NODE 3 ^": how many there are, and the column that they are sorted by.
std::string heading_of(const listing& shown, size_t column,
                       const listing_style& style) {
  auto name = shown.columns[column].name;
  if (column == 0)
    name += " " + std::to_string(shown.items.size());
  if (column == style.order.column)
    name += style.order.backwards ? " v" : " ^";
  return name;
}

/// What the bars of a column have in common, so that they can be compared.
struct bar_column {
  size_t words = 0;   ///< Columns behind each bar; 0: there are no bars.
  bool exact = false; ///< There is room for the exact numbers.
};

struct fitted_listing {
  std::vector<size_t> widths; ///< 0: left out.
  std::vector<bar_column> bars;
};

/// @param words columns behind its bars; 0: there are none.
column_request request_of_column(const listing& shown, size_t i, size_t heading,
                                 size_t words) {
  const auto& what = shown.columns[i];
  column_request result;
  result.natural = std::max(heading, words > 0 ? least_bar + 1 + words : 0);
  bool empty = true;
  for (const auto& x : shown.items) {
    const auto& text = x.cells.at(i).text;
    result.natural = std::max(result.natural, display_width(text));
    empty = empty && text.empty();
  }
  const bool whole = what.side == align::right || what.whole || words > 0;
  result.least = whole
                     ? result.natural
                     : std::max(heading, std::min(result.natural, least_text));
  result.rank = what.rank + (empty && what.rank > 0 ? empty_column_rank : 0);
  return result;
}

/// Columns of the longest words behind the bars of a column.
size_t longest_words(const listing& shown, size_t i, std::string cell::*words) {
  size_t result = 0;
  for (const auto& x : shown.items)
    if (x.cells.at(i).usage)
      result = std::max(result, display_width(x.cells.at(i).*words));
  return result;
}

/// Exact numbers behind the bars of a column, if they all find room.
void choose_texts(const listing& shown, fitted_listing& fit) {
  for (size_t i = 0; i < fit.bars.size(); ++i) {
    const auto exact = longest_words(shown, i, &cell::more);
    if (fit.bars[i].words > 0 && fit.widths[i] >= least_bar + 1 + exact)
      fit.bars[i] = {exact, true};
  }
}

/// Room that nothing else takes makes bars longer.
void stretch_bars(fitted_listing& fit, size_t width) {
  size_t used = 0;
  size_t bars = 0;
  for (size_t i = 0; i < fit.widths.size(); ++i) {
    used += fit.widths[i] > 0 ? fit.widths[i] + gap : 0;
    bars += fit.widths[i] > 0 && fit.bars[i].words > 0 ? 1 : 0;
  }
  if (bars == 0 || used >= width + gap)
    return;
  const auto more = std::min(longest_bar, (width + gap - used) / bars);
  for (size_t i = 0; i < fit.widths.size(); ++i)
    if (fit.widths[i] > 0 && fit.bars[i].words > 0)
      fit.widths[i] += more;
}

fitted_listing fit_listing(const listing& shown, const listing_style& style) {
  fitted_listing result;
  std::vector<column_request> requests;
  for (size_t i = 0; i < shown.columns.size(); ++i) {
    const auto words = longest_words(shown, i, &cell::text);
    result.bars.push_back({words, false});
    requests.push_back(request_of_column(
        shown, i, display_width(heading_of(shown, i, style)), words));
  }
  const auto width = style.width > mark_width ? style.width - mark_width : 0;
  result.widths = fitted(requests, width);
  stretch_bars(result, width);
  choose_texts(shown, result);
  return result;
}

void put_bar(line& to, const cell& x, size_t width, const bar_column& how,
             bool utf8) {
  const auto& words = how.exact ? x.more : x.text;
  const auto length = width - std::min(width, how.words + 1);
  for (auto& part : bar(*x.usage, length, utf8))
    to.spans.push_back(std::move(part));
  const auto blanks = how.words - std::min(how.words, display_width(words));
  put(to, std::string(1 + blanks, ' ') + words, x.how);
}

void put_cell(line& to, const cell& x, align side, size_t width,
              const bar_column& how, bool utf8) {
  if (width_of(to) > mark_width)
    put(to, std::string(gap, ' '));
  const auto end = width_of(to) + width;
  if (x.usage)
    put_bar(to, x, width, how, utf8);
  else {
    const auto text =
        shortened(printable(x.text.empty() ? "-" : x.text), width);
    if (side == align::right)
      pad(to, end - display_width(text));
    put(to, text, x.text.empty() ? look::faint : x.how);
  }
  pad(to, end);
}

line heading_line(const listing& shown, const fitted_listing& fit,
                  const listing_style& style) {
  line result;
  put(result, style.focused ? ">" : " ");
  for (size_t i = 0; i < shown.columns.size(); ++i)
    if (fit.widths[i] > 0)
      put_cell(result, {heading_of(shown, i, style)}, shown.columns[i].side,
               fit.widths[i], {}, style.utf8);
  pad(result, style.width);
  for (auto& part : result.spans)
    part.how = look::heading;
  return cut(result, style.width);
}

line row_line(const listing& shown, const item& x, const fitted_listing& fit,
              const listing_style& style) {
  line result;
  result.selected = style.focused && x.id == style.selected;
  put(result, result.selected ? ">" : " ");
  for (size_t i = 0; i < x.cells.size(); ++i)
    if (fit.widths[i] > 0)
      put_cell(result, x.cells[i], shown.columns[i].side, fit.widths[i],
               fit.bars[i], style.utf8);
  return cut(result, style.width);
}

/// A line below a thing: its bar stands under the first bar of the thing.
line line_below(const std::vector<cell>& cells, const fitted_listing& fit,
                const listing_style& style) {
  line result;
  put(result, "   " + cells.front().text, look::faint);
  size_t first = 0;
  size_t start = mark_width;
  while (first < fit.widths.size()
         && (fit.widths[first] == 0 || fit.bars[first].words == 0)) {
    start += fit.widths[first] > 0 ? fit.widths[first] + gap : 0;
    ++first;
  }
  pad(result, start - std::min(start, gap));
  for (size_t i = 1; i < cells.size(); ++i) {
    const bool is_bar = cells[i].usage && first < fit.widths.size();
    put_cell(result, cells[i], align::left,
             is_bar ? fit.widths[first] : display_width(cells[i].text),
             is_bar ? fit.bars[first] : bar_column{}, style.utf8);
  }
  return cut(result, style.width);
}

} // namespace

size_t whole_height(const listing& shown) {
  size_t result = 1;
  for (const auto& x : shown.items)
    result += 1 + x.below.size();
  return result;
}

std::vector<line> listing_lines(const listing& shown,
                                const listing_style& style) {
  if (style.height == 0)
    return {};
  const auto fit = fit_listing(shown, style);
  const auto room = style.height - 1;
  size_t selected = 0;
  size_t total = 0;
  for (const auto& x : shown.items) {
    if (x.id == style.selected)
      selected = total;
    total += 1 + x.below.size();
  }
  // The cursor stays in the middle where there is more on both sides.
  auto first = selected > room / 2 ? selected - room / 2 : 0;
  first = std::min(first, total > room ? total - room : 0);
  std::vector<line> result{heading_line(shown, fit, style)};
  size_t at = 0;
  const auto add = [&](const auto& make) {
    if (at >= first && at < first + room)
      result.push_back(make());
    ++at;
  };
  for (const auto& x : shown.items) {
    add([&] { return row_line(shown, x, fit, style); });
    for (const auto& cells : x.below)
      add([&] { return line_below(cells, fit, style); });
  }
  return result;
}

} // namespace roscell::cli::top
