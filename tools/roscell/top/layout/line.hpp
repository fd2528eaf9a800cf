#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::cli::top {

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

std::string text_of(const line& x);

/// The look of a state word such as "running"; plain for any other text.
look look_of_state(const std::string& word);

} // namespace roscell::cli::top
