#pragma once

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

/// What printed text says, whatever the widths of its columns. How a table is
/// set, blank by blank, is told in table_test.cpp, once for all of them.
namespace roscell::test {

/// The text with "|" between two columns, which two blanks or more stand for.
inline std::string cells_in(const std::string& text) {
  std::string result;
  for (size_t at = 0; at < text.size(); ++at) {
    const auto end = std::min(text.find_first_not_of(' ', at), text.size());
    const bool is_gap = end > at + 1;
    result += is_gap ? '|' : text[at];
    at = is_gap ? end - 1 : at;
  }
  return result;
}

/// A cell of a printed line, and where it stands on the screen.
struct printed_cell {
  std::string text;
  size_t begin;
  size_t end;
};

inline std::vector<printed_cell> placed_cells(const std::string& line) {
  std::vector<printed_cell> result;
  for (auto at = line.find_first_not_of(' '); at != std::string::npos;) {
    const auto end = std::min(line.find("  ", at), line.size());
    result.push_back({line.substr(at, end - at),
                      cli::display_width(line.substr(0, at)),
                      cli::display_width(line.substr(0, end))});
    at = line.find_first_not_of(' ', end);
  }
  return result;
}

/// The headings that all cells below end with, but do not all begin with: those
/// of numbers. "|" is between them.
inline std::string right_aligned(const std::string& text) {
  std::istringstream lines{text};
  std::vector<std::vector<printed_cell>> rows;
  for (std::string line; std::getline(lines, line);)
    rows.push_back(placed_cells(line));
  std::string result;
  for (size_t i = 0; i < rows.front().size(); ++i) {
    const auto& heading = rows.front()[i];
    const auto stand_alike = [&](size_t printed_cell::*side) {
      return std::all_of(rows.begin(), rows.end(), [&](const auto& row) {
        return row.at(i).*side == heading.*side;
      });
    };
    if (stand_alike(&printed_cell::end) && !stand_alike(&printed_cell::begin))
      result += (result.empty() ? "" : "|") + heading.text;
  }
  return result;
}

/// The columns that the longest line takes.
inline size_t widest_line(const std::string& text) {
  std::istringstream lines{text};
  size_t result = 0;
  for (std::string line; std::getline(lines, line);)
    result = std::max(result, cli::display_width(line));
  return result;
}

} // namespace roscell::test
