#pragma once

#include "messages/cell.hpp"
#include "messages/topic.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

/// The columns in which things of one kind are listed, each described once: for
/// tables on a terminal, for `top` and for the dashboard.
namespace roscell::cli {

/// What stands in one column.
template <class Row>
struct described_column {
  column what;
  cell (*of)(const Row& row, const view_style& style);
  /// How the dashboard says it, a word of tools/dashboard/pages/columns.js;
  /// empty: it does not show it.
  const char* said_as = "";
  const char* path = ""; ///< Of what it is read from, in the JSON of a row.
};

template <class Row>
using column_list = std::vector<described_column<Row>>;

const column_list<registry_row>& node_columns();
const column_list<task_row>& task_columns();
const column_list<instance_row>& instance_columns();
const column_list<topic_row>& topic_columns();

/// Those of these names, as they are wanted here.
template <class Row>
column_list<Row> picked(const column_list<Row>& all,
                        const std::vector<column>& wanted) {
  column_list<Row> result;
  for (const auto& x : wanted)
    for (const auto& known : all)
      if (known.what.name == x.name)
        result.push_back({x, known.of});
  return result;
}

/// A table of these things.
template <class Row>
table table_of(const column_list<Row>& columns, const std::vector<Row>& rows,
               const view_style& style) {
  table result;
  for (const auto& x : columns)
    result.columns.push_back(x.what);
  for (const auto& row : rows) {
    auto& to = result.rows.emplace_back();
    for (const auto& x : columns)
      to.push_back(x.of(row, style));
  }
  return result;
}

/// The nodes of a cell, then those that are in none.
table nodes_table(const cell_description& cell, const view_style& style);

} // namespace roscell::cli
