#pragma once

#include <string>
#include <vector>

namespace roscell::cli {

/// What of a table is shown, and in which order.
struct table_options {
  bool wide = false;                ///< All columns, and nothing is cut.
  bool headings = true;             ///< The line of headings.
  std::vector<std::string> columns; ///< Only these; empty: the usual ones.
  std::string sort; ///< By this column, from its end if "-" is before it.
};

/// How text is put on the terminal, or into a file.
struct text_style {
  bool colour = false;  ///< With escape sequences for colours.
  size_t width = 0;     ///< Longer lines are cut; 0: never.
  table_options tables; ///< For those that list something.
};

enum class align { left, right };

/// What a column may lose where the terminal is too narrow.
constexpr int always_shown = 0;
/// Shown with `wide`, or when it is named, only.
constexpr int only_wide = 100;

struct column {
  std::string name;
  align side = align::left;
  /// The columns of the highest number are shortened and left out first.
  int rank = always_shown;
  bool whole = false; ///< A part of it says nothing: it is not shortened.
};

/// Rows under a line of headings. Cells hold foreign text as it came; what a
/// terminal must not get is replaced when the table is rendered.
struct table {
  std::vector<column> columns;
  std::vector<std::vector<std::string>> rows;

  /// The table as text, each line ended, columns two blanks apart. An empty
  /// cell is shown as "-". A known state word gets a colour. What does not fit
  /// is left out, and a last line names it. Throws command_error if the style
  /// names a column that there is not.
  std::string render(const text_style& style) const;
};

/// The colour of a state word ("running", "failed") as an escape sequence;
/// empty for any other text.
std::string state_colour(const std::string& word);

} // namespace roscell::cli
