#pragma once

#include "tools/roscell/top/layout/listing.hpp"

#include <string>
#include <vector>

namespace roscell::cli::top {

/// How a list is put on the screen.
struct listing_style {
  size_t width = 80;
  size_t height = 24;   ///< The line of headings included.
  bool utf8 = true;     ///< The terminal can show more than ASCII.
  bool focused = false; ///< Keys mean this list.
  std::string selected; ///< Id of the thing under the cursor.
  item_order order;
};

/// A line of headings and as many things as there is room for, the selected one
/// among them. Columns are shortened, then left out, where there is no room;
/// what is left over makes bars longer.
std::vector<line> listing_lines(const listing& shown,
                                const listing_style& style);

/// How many lines that would take with all of its things.
size_t whole_height(const listing& shown);

} // namespace roscell::cli::top
