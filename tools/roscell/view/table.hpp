#pragma once

#include "client/column.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Lines for people, of which each part looks as what it means.
namespace roscell::cli {

struct span {
  std::string text; ///< UTF-8, safe for a terminal.
  look how = look::plain;
};

struct line {
  std::vector<span> spans;
  bool selected = false; ///< The whole line is marked.
};

/// Puts text, cleaned, to the end of a line.
void put(line& to, const std::string& text, look how = look::plain);

/// Blanks up to that column.
void pad(line& to, size_t column);

/// Columns that it takes.
size_t width_of(const line& x);

/// It without what is beyond that column.
line cut(line x, size_t width);

/// As it is written to a file or, with colours, to a terminal; without its end.
std::string text_of(const line& x, bool colours = false);

/// The look of a state word ("running", "failed"); plain for any other text.
look look_of_state(const std::string& word);

/// The escape sequence that a look begins with; empty if it has none.
std::string colour_of(look how);

/// That of a state word.
std::string state_colour(const std::string& word);

/// What of a table is shown, and in which order.
struct table_options {
  bool wide = false;                ///< All columns, and nothing is cut.
  bool headings = true;             ///< The line of headings.
  std::vector<std::string> columns; ///< Only these; empty: the usual ones.
  std::string sort; ///< By this column, from its end if "-" is before it.
  std::string filter = {}; ///< Only rows in which this stands, in any case.
};

/// How text is put on the terminal, or into a file.
struct text_style {
  bool colour = false;  ///< With escape sequences for colours.
  size_t width = 0;     ///< Longer lines are cut; 0: never.
  table_options tables; ///< For those that list something.
  bool bars = false;    ///< Parts of a resource are drawn, too.
  bool utf8 = true;     ///< These bars may have more than ASCII.
};

/// A bar of that width: what others use, what is reserved, and what is free,
/// each with a character of its own. What is there at all is seen, as far as
/// there is room. Without UTF-8 it is "##++....".
std::vector<span> bar(const usage_share& of, size_t width, bool utf8);

using cell = column_value;

/// Rows under a line of headings. What a terminal must not get of their cells
/// is replaced when the table is rendered.
struct table {
  std::vector<column> columns;
  std::vector<std::vector<cell>> rows;

  /// The table as text, each line ended, columns two blanks apart. An empty
  /// cell is shown as "-". A known state word gets a colour. What does not fit
  /// is left out, and a last line names it. Throws command_error if the style
  /// names a column that there is not.
  std::string render(const text_style& style) const;

  /// The same line by line, the headings first, without the last line.
  std::vector<line> lines(const text_style& style) const;
};

/// The columns that the options choose of a table, and of its rows those that
/// they do, in their order. Throws command_error for a column that there is
/// not.
table chosen(const table& all, const table_options& options);

/// The number of the column that a name means: "discovery-server" is "DISCOVERY
/// SERVER". Nothing if there is none.
std::optional<size_t> column_of(const table& all, const std::string& name);

/// The value of a cell that begins with a number: "12", "-1.5", "0.8/3.8 GiB"
/// (in bytes), "3m05s" (in seconds), "29.9 Hz". Nothing for any other text.
std::optional<double> cell_value(std::string_view text);

/// Whether `part` stands in the text, in any case.
bool contains_words(const std::string& text, const std::string& part);

// INTERNAL to tables: what is given up where a terminal is too narrow.

/// A column that wants a place.
struct column_request {
  size_t natural = 0; ///< Of its widest cell, the heading included.
  size_t least = 0;   ///< It may be shortened to this.
  int rank = 0; ///< The highest is shortened and left out first; 0: it stays.
};

/// Widths for the columns, two blanks apart, that make no line longer than
/// `width`: columns are shortened, then left out (0). Only those that stay may
/// be too wide together.
std::vector<size_t> fitted(const std::vector<column_request>& columns,
                           size_t width);

} // namespace roscell::cli
