#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Lines for people, of which each part looks as what it means.
namespace roscell::cli {

/// How a part of a line looks, by what it means: a screen without colours shows
/// it otherwise.
enum class look {
  plain,
  strong,
  faint,
  heading,
  good,
  busy,
  bad,
  others,   ///< Of a bar: used by other programs.
  reserved, ///< Of a bar: reserved by instances.
};

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

} // namespace roscell::cli
