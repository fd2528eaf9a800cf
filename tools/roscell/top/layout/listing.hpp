#pragma once

#include "tools/roscell/top/layout/bar.hpp"
#include "tools/roscell/view/table.hpp"

#include <optional>
#include <string>
#include <vector>

namespace roscell::cli::top {

/// What stands in one column of a row.
struct cell {
  std::string text;           ///< Of a bar, what stands behind it.
  look how = look::plain;     ///< Of the text.
  std::optional<share> usage; ///< It is a bar.
  std::string more; ///< Instead of the text, where a wide bar has room.
};

/// A thing with its row, and lines below it that belong to it.
struct item {
  std::string id;
  std::vector<cell> cells;
  std::vector<std::vector<cell>> below; ///< A name, and a bar, each.
};

/// Things of one kind.
struct listing {
  std::vector<column> columns; ///< The first has the name of the list.
  std::vector<item> items;
};

/// In which order things are shown.
struct item_order {
  size_t column = 0;
  bool backwards = false;
};

/// The number of the column that a name means, as the tables take it. Nothing
/// if there is none.
std::optional<size_t> column_of(const listing& all, const std::string& name);

/// The things in which the filter stands, in any case, in that order; what is
/// not known is last. An empty filter is in all of them.
listing chosen(listing all, const std::string& filter, const item_order& order);

/// Whether `part` stands in the text, in any case.
bool contains_words(const std::string& text, const std::string& part);

} // namespace roscell::cli::top
