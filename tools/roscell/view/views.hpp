#pragma once

#include "messages/cell.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/node.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"
#include "tools/roscell/view/table.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// The replies of a node as text for people. `now_unix_ms` is the time that
/// ages are counted to.
namespace roscell::cli {

/// What a view needs to know besides the reply.
struct view_style {
  text_style text;
  int64_t now_unix_ms = 0;
};

std::string node_view(const node_description& node, const view_style& style);

/// The part of a status that only a coordinator can tell.
std::string cell_summary(const cell_description& cell, const view_style& style);

/// The actors of a node with their counters, as a tree of who spawned whom.
std::string actors_view(const std::vector<actor_row>& actors,
                        const view_style& style);

/// Those of these columns, as they are wanted here.
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
      to.push_back(x.of(row, style.now_unix_ms));
  }
  return result;
}

/// A table, or "no tasks".
std::string or_nothing(const table& t, const char* what,
                       const view_style& style);

/// The nodes of a cell, then those that are in none.
table nodes_table(const cell_description& cell, const view_style& style);

std::string cells_view(const cell_list& cells, const view_style& style);

/// The rows of the registry, and below them the nodes that are in no cell.
std::string members_view(const cell_description& cell, const view_style& style);
std::string tasks_view(const task_description& tasks, const view_style& style);

/// The same, and below it the steps, with how long data are under way.
std::string task_view(const task_description& tasks, const view_style& style);
std::string instances_view(const instance_description& instances,
                           const view_style& style);

/// The same for one, and below it how its earlier runs ended.
std::string instance_view(const instance_description& instances,
                          const view_style& style);
std::string skills_view(const skill_list& skills, const view_style& style);

// The JSON that the command line prints (docs/output/): one shape for one
// thing, whichever command prints it and wherever in a document it stands.

/// What a node tells of a thing, as programs get it: with its `name`; times as
/// ISO 8601 in UTC, `since` instead of `since_unix_ms`, null where they are not
/// known; ends of a stream always as a list. The same for what is inside it.
json shaped(const json& reported);

/// Members of a reply; an empty name is none.
using reply_parts = std::array<std::string_view, 2>;

/// The things of a reply as a list, each `shaped`: those in these parts of it,
/// or, where none is named, the reply itself.
json shaped_list(const json& reply, const reply_parts& parts);

} // namespace roscell::cli
