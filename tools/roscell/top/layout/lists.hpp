#pragma once

#include "client/known_cell.hpp"
#include "tools/roscell/view/table.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// The lists that `top` shows: the tables of nodes, tasks and instances. A
/// thing is named by its first cell.
namespace roscell::cli::top {

/// In the order in which they stand on the screen.
constexpr std::array<thing_kind, 3> listed_kinds{
    thing_kind::node, thing_kind::task, thing_kind::instance};

using tables = std::array<table, listed_kinds.size()>;

/// By which column a list is sorted.
struct list_order {
  std::string column; ///< Empty: the first.
  bool backwards = false;
};

/// All of them, with every column.
tables all_lists(const known_cell& known, int64_t now_unix_ms);

/// The usual columns, and the rows in which the filter stands, in that order.
table ordered(const table& all, const std::string& filter,
              const list_order& order);

/// How a list is put on the screen.
struct list_style {
  size_t width = 80;
  size_t height = 24;   ///< The line of headings included.
  bool utf8 = true;     ///< The terminal can show more than ASCII.
  bool focused = false; ///< Keys mean this list.
  size_t selected = 0;  ///< The row under the cursor.
  list_order order;
};

/// A line of headings and as many rows as there is room for, the selected one
/// among them.
std::vector<line> list_lines(table shown, const list_style& style);

} // namespace roscell::cli::top
