#include "tools/roscell/view/table.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table/choice.hpp"
#include "tools/roscell/view/table/fit.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

constexpr auto bold = "\x1b[1m";
constexpr auto plain = "\x1b[0m";

using cells = std::vector<std::string>;

/// Cells of a row, cleaned, one for each column.
cells clean(const cells& row, size_t columns) {
  cells result;
  for (size_t i = 0; i < columns; ++i) {
    const bool empty = i >= row.size() || row[i].empty();
    result.push_back(empty ? "-" : printable(row[i]));
  }
  return result;
}

/// Puts text into the columns that are left of a line.
class line_writer {
public:
  line_writer(std::string& out, const text_style& style)
      : out_{out}, style_{style} {}

  void put(std::string_view text, const std::string& colour = {}) {
    std::string part{text};
    if (style_.width != 0)
      part = shortened(part, style_.width - std::min(style_.width, used_));
    used_ += display_width(part);
    if (style_.colour && !colour.empty() && !part.empty())
      part = colour + part + plain;
    out_ += part;
  }

  void pad(size_t columns) {
    put(std::string(columns, ' '));
  }

private:
  std::string& out_;
  const text_style& style_;
  size_t used_ = 0;
};

} // namespace

std::string state_colour(const std::string& word) {
  static constexpr std::string_view good[] = {
      "running",        "active", "member",   "deployed", "optimal", "joined",
      "already_member", "done",   "finished", "ok",       "✓"};
  static constexpr std::string_view bad[] = {
      "failed",  "lost",   "orphaned",         "degraded",           "returned",
      "unknown", "silent", "running, starved", "running, unhealthy", "broken",
      "✗"};
  static constexpr std::string_view moving[] = {
      "pending",     "building",    "starting",  "stopping",
      "joining",     "switching",   "deploying", "reserved",
      "terminating", "departing",   "expected",  "preparing",
      "unresolved",  "backing_off", "warning",   "!"};
  const auto is_in = [&](const auto& list) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
  };
  return is_in(good)     ? "\x1b[32m"
         : is_in(bad)    ? "\x1b[31m"
         : is_in(moving) ? "\x1b[33m"
                         : "";
}

namespace {

/// Short of this a word says little.
constexpr size_t least_width = 8;

/// A column in which nothing stands is the first that can be spared.
constexpr int empty_rank = only_wide;

/// @param heading columns of its name, where that is shown.
column_request column_request_of(const column& what, size_t i, size_t heading,
                                 const std::vector<cells>& lines) {
  column_request result;
  result.natural = heading;
  bool empty = true;
  for (const auto& line : lines) {
    result.natural = std::max(result.natural, display_width(line[i]));
    empty = empty && line[i] == "-";
  }
  result.rank = what.rank + (empty && what.rank > 0 ? empty_rank : 0);
  // A number that is cut would be another one.
  result.least = what.side == align::right || what.whole
                     ? result.natural
                     : std::max(heading, std::min(result.natural, least_width));
  return result;
}

/// One line of a table.
void put_line(std::string& out, const table& t, const cells& line,
              const std::vector<size_t>& widths, const text_style& style,
              bool is_heading) {
  line_writer writer{out, style};
  bool first = true;
  for (size_t i = 0; i < line.size(); ++i) {
    if (widths[i] == 0)
      continue;
    if (!std::exchange(first, false))
      writer.pad(2);
    const auto text = shortened(line[i], widths[i]);
    const auto gap = widths[i] - display_width(text);
    if (t.columns[i].side == align::right)
      writer.pad(gap);
    writer.put(text, is_heading ? bold : state_colour(line[i]));
    const bool last =
        std::all_of(widths.begin() + static_cast<long>(i) + 1, widths.end(),
                    [](size_t w) { return w == 0; });
    if (t.columns[i].side == align::left && !last)
      writer.pad(gap);
  }
  out += '\n';
}

/// "3 columns left out: A, B, C; -o wide shows all"
std::string left_out(const table& t, const std::vector<size_t>& widths) {
  std::vector<std::string> names;
  for (size_t i = 0; i < widths.size(); ++i)
    if (widths[i] == 0)
      names.push_back(t.columns[i].name);
  if (names.empty())
    return {};
  return std::to_string(names.size())
         + (names.size() == 1 ? " column" : " columns")
         + " left out: " + joined(names, ", ") + "; -o wide shows all";
}

std::vector<size_t> widths_of(const table& t, const std::vector<cells>& lines,
                              const text_style& style) {
  std::vector<column_request> requests;
  for (size_t i = 0; i < t.columns.size(); ++i)
    requests.push_back(column_request_of(
        t.columns[i], i,
        style.tables.headings ? display_width(t.columns[i].name) : 0, lines));
  return fitted(requests, style.width == 0 ? SIZE_MAX / 2 : style.width);
}

} // namespace

std::string table::render(const text_style& style) const {
  const auto shown = chosen(*this, style.tables);
  auto limited = style;
  if (style.tables.wide)
    limited.width = 0;
  std::vector<cells> lines;
  for (const auto& row : shown.rows)
    lines.push_back(clean(row, shown.columns.size()));
  const auto widths = widths_of(shown, lines, limited);
  std::string out;
  if (style.tables.headings) {
    cells heading;
    for (const auto& c : shown.columns)
      heading.push_back(c.name);
    put_line(out, shown, heading, widths, limited, true);
  }
  for (const auto& line : lines)
    put_line(out, shown, line, widths, limited, false);
  const auto note = left_out(shown, widths);
  if (!note.empty())
    out += (limited.width == 0 ? note : shortened(note, limited.width)) + "\n";
  return out;
}

} // namespace roscell::cli
