#pragma once

#include <cstddef>
#include <vector>

/// INTERNAL to tables: what is given up where a terminal is too narrow.
namespace roscell::cli {

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
