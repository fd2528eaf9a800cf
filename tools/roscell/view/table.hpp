#pragma once

#include <string>
#include <vector>

namespace roscell::cli {

/// How text is put on the terminal, or into a file.
struct text_style {
  bool colour = false; ///< With escape sequences for colours.
  size_t width = 0;    ///< Longer lines are cut; 0: never.
};

enum class align { left, right };

struct column {
  std::string name;
  align side = align::left;
};

/// Rows under a line of headings. Cells hold foreign text as it came; what a
/// terminal must not get is replaced when the table is rendered.
struct table {
  std::vector<column> columns;
  std::vector<std::vector<std::string>> rows;

  /// The table as text, each line ended, columns two blanks apart. An empty
  /// cell is shown as "-". A known state word gets a colour.
  std::string render(const text_style& style) const;
};

/// The colour of a state word ("running", "failed") as an escape sequence;
/// empty for any other text.
std::string state_colour(const std::string& word);

} // namespace roscell::cli
