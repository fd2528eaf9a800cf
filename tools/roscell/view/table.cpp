#include "tools/roscell/view/table.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace roscell::cli {

namespace {

constexpr size_t column_gap = 2;

/// Short of this a word says little.
constexpr size_t least_width = 8;

/// A column in which nothing stands is the first that can be spared.
constexpr int empty_rank = only_wide;

constexpr size_t cell_bar_width = 10;

/// Above it a resource is nearly used up.
constexpr double nearly_all = 0.9;

/// A table that has been given its columns.
struct fitted_table {
  table shown;
  std::vector<size_t> widths; ///< 0: left out.
};

/// A column of signs has no heading.
std::string shown_text(const cell& x) {
  const bool is_nothing = x.text.empty() && x.how != look::heading;
  return is_nothing ? "-" : printable(x.text);
}

size_t natural_width(const cell& x, const text_style& style) {
  return display_width(shown_text(x))
         + (style.bars && x.usage ? cell_bar_width + 1 : 0);
}

column_request request_of(const table& t, size_t i, const text_style& style) {
  const auto& what = t.columns[i];
  const auto heading = style.tables.headings ? display_width(what.name) : 0;
  column_request result;
  result.natural = heading;
  bool empty = true;
  bool whole = what.side == align::right || what.whole;
  for (const auto& row : t.rows) {
    result.natural = std::max(result.natural, natural_width(row[i], style));
    empty = empty && row[i].text.empty();
    whole = whole || row[i].usage;
  }
  result.rank = what.rank + (empty && what.rank > 0 ? empty_rank : 0);
  // A number that is cut would be another one.
  result.least = whole
                     ? result.natural
                     : std::max(heading, std::min(result.natural, least_width));
  return result;
}

fitted_table fit_table(const table& all, const text_style& style) {
  fitted_table result{chosen(all, style.tables), {}};
  std::vector<column_request> requests;
  for (size_t i = 0; i < result.shown.columns.size(); ++i)
    requests.push_back(request_of(result.shown, i, style));
  result.widths =
      fitted(requests, style.width == 0 ? SIZE_MAX / 2 : style.width);
  return result;
}

look look_of(const cell& x, const text_style& style) {
  if (style.bars && x.usage
      && x.usage->others + x.usage->reserved >= nearly_all * x.usage->capacity)
    return look::bad;
  return x.how == look::plain ? look_of_state(x.text) : x.how;
}

/// Puts a cell into its columns of a line.
/// @param ends nothing follows in this line.
void put_cell(line& to, const cell& x, align side, size_t width, bool ends,
              const text_style& style) {
  const auto end = width_of(to) + width;
  if (style.bars && x.usage) {
    const auto length = std::min(width, cell_bar_width);
    for (auto& part : bar(*x.usage, length, style.utf8))
      to.spans.push_back(std::move(part));
    width -= length;
  }
  const auto text = shortened(shown_text(x), width);
  if (side == align::right || x.usage)
    pad(to, end - display_width(text));
  put(to, text, look_of(x, style));
  if (!ends)
    pad(to, end);
}

line line_of(const fitted_table& t, const std::vector<cell>& row,
             const text_style& style) {
  size_t last = t.widths.size();
  while (last > 0 && t.widths[last - 1] == 0)
    --last;
  line result;
  for (size_t i = 0; i < last; ++i) {
    if (t.widths[i] == 0)
      continue;
    if (!result.spans.empty())
      put(result, std::string(column_gap, ' '));
    put_cell(result, row[i], t.shown.columns[i].side, t.widths[i],
             i + 1 == last, style);
  }
  return style.width == 0 ? result : cut(std::move(result), style.width);
}

std::vector<line> lines_of_table(const fitted_table& t,
                                 const text_style& style) {
  std::vector<line> result;
  if (style.tables.headings) {
    std::vector<cell> names;
    for (const auto& x : t.shown.columns)
      names.emplace_back(x.name, look::heading);
    result.push_back(line_of(t, names, style));
  }
  for (const auto& row : t.shown.rows)
    result.push_back(line_of(t, row, style));
  return result;
}

/// "3 columns left out: A, B, C; -o wide shows all"
std::string left_out(const fitted_table& t) {
  std::vector<std::string> names;
  for (size_t i = 0; i < t.widths.size(); ++i)
    if (t.widths[i] == 0)
      names.push_back(t.shown.columns[i].name);
  if (names.empty())
    return {};
  return std::to_string(names.size())
         + (names.size() == 1 ? " column" : " columns")
         + " left out: " + joined(names, ", ") + "; -o wide shows all";
}

std::string repeated(const char* glyph, size_t count) {
  std::string result;
  for (size_t i = 0; i < count; ++i)
    result += glyph;
  return result;
}

/// Columns for a part of a bar, at least one for what is there at all.
size_t columns_for(double amount, double capacity, size_t width, size_t room) {
  if (!(amount > 0) || !(capacity > 0))
    return 0;
  const auto exact =
      std::min(1.0, amount / capacity) * static_cast<double>(width);
  const auto columns = static_cast<size_t>(std::lround(exact));
  return std::min(room, std::max<size_t>(1, columns));
}

} // namespace

std::vector<span> bar(const usage_share& of, size_t width, bool utf8) {
  const auto reserved = columns_for(of.reserved, of.capacity, width, width);
  const auto others =
      columns_for(of.others, of.capacity, width, width - reserved);
  return {{repeated(utf8 ? "█" : "#", others), look::others},
          {repeated(utf8 ? "▒" : "+", reserved), look::reserved},
          {repeated(utf8 ? "·" : ".", width - others - reserved), look::faint}};
}

std::vector<line> table::lines(const text_style& style) const {
  return lines_of_table(fit_table(*this, style), style);
}

std::string table::render(const text_style& style) const {
  auto limited = style;
  if (style.tables.wide)
    limited.width = 0;
  const auto t = fit_table(*this, limited);
  std::string out;
  for (const auto& x : lines_of_table(t, limited))
    out += text_of(x, style.colour) + "\n";
  if (const auto note = left_out(t); !note.empty())
    out += (limited.width == 0 ? note : shortened(note, limited.width)) + "\n";
  return out;
}

namespace {

constexpr std::string_view good_states[] = {
    "running",        "active", "member",   "deployed", "optimal", "joined",
    "already_member", "done",   "finished", "ok",       "✓"};

constexpr std::string_view bad_states[] = {
    "failed",  "lost",   "orphaned",         "degraded",           "returned",
    "unknown", "silent", "running, starved", "running, unhealthy", "broken",
    "✗"};

constexpr std::string_view busy_states[] = {
    "pending",     "building",    "starting",  "stopping",
    "joining",     "switching",   "deploying", "reserved",
    "terminating", "departing",   "expected",  "preparing",
    "unresolved",  "backing_off", "warning",   "!"};

template <class Words>
bool is_one_of(const std::string& word, const Words& words) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

} // namespace

void put(line& to, const std::string& text, look how) {
  if (!text.empty())
    to.spans.push_back({printable(text), how});
}

void pad(line& to, size_t column) {
  const auto width = width_of(to);
  if (width < column)
    put(to, std::string(column - width, ' '));
}

size_t width_of(const line& x) {
  size_t width = 0;
  for (const auto& part : x.spans)
    width += display_width(part.text);
  return width;
}

line cut(line x, size_t width) {
  size_t used = 0;
  for (auto& part : x.spans) {
    part.text = shortened(part.text, width - used);
    used += display_width(part.text);
  }
  return x;
}

std::string text_of(const line& x, bool colours) {
  std::string text;
  for (const auto& part : x.spans) {
    const auto colour =
        colours && !part.text.empty() ? colour_of(part.how) : "";
    text += colour + part.text + (colour.empty() ? "" : "\x1b[0m");
  }
  return text;
}

look look_of_state(const std::string& word) {
  return is_one_of(word, good_states)   ? look::good
         : is_one_of(word, bad_states)  ? look::bad
         : is_one_of(word, busy_states) ? look::busy
                                        : look::plain;
}

std::string colour_of(look how) {
  switch (how) {
  case look::strong:
  case look::heading:
    return "\x1b[1m";
  case look::good:
    return "\x1b[32m";
  case look::bad:
    return "\x1b[31m";
  case look::busy:
    return "\x1b[33m";
  default:
    return {};
  }
}

std::string state_colour(const std::string& word) {
  return colour_of(look_of_state(word));
}

} // namespace roscell::cli
