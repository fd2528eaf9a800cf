#include "tools/roscell/view/table.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <string_view>

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
      "running", "active",         "member", "deployed", "optimal",
      "joined",  "already_member", "done",   "finished"};
  static constexpr std::string_view bad[] = {"failed",   "lost",     "orphaned",
                                             "degraded", "returned", "unknown"};
  static constexpr std::string_view moving[] = {
      "pending",   "building",  "starting",  "stopping",    "joining",
      "switching", "deploying", "reserved",  "terminating", "departing",
      "expected",  "preparing", "unresolved"};
  const auto is_in = [&](const auto& list) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
  };
  return is_in(good)     ? "\x1b[32m"
         : is_in(bad)    ? "\x1b[31m"
         : is_in(moving) ? "\x1b[33m"
                         : "";
}

std::string table::render(const text_style& style) const {
  std::vector<cells> lines;
  cells heading;
  for (const auto& c : columns)
    heading.push_back(c.name);
  lines.push_back(heading);
  for (const auto& row : rows)
    lines.push_back(clean(row, columns.size()));
  std::vector<size_t> widths(columns.size(), 0);
  for (const auto& line : lines)
    for (size_t i = 0; i < line.size(); ++i)
      widths[i] = std::max(widths[i], display_width(line[i]));
  std::string out;
  for (const auto& line : lines) {
    line_writer writer{out, style};
    for (size_t i = 0; i < line.size(); ++i) {
      const auto gap = widths[i] - display_width(line[i]);
      const bool last = i + 1 == line.size();
      if (columns[i].side == align::right)
        writer.pad(gap);
      writer.put(line[i],
                 &line == &lines.front() ? bold : state_colour(line[i]));
      if (!last)
        writer.pad((columns[i].side == align::left ? gap : 0) + 2);
    }
    out += '\n';
  }
  return out;
}

} // namespace roscell::cli
