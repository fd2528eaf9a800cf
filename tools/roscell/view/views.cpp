#include "tools/roscell/view/views.hpp"

#include "actors/edge/io/node_time.hpp"
#include "client/columns.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <string>

namespace roscell::cli {

namespace {

/// What is wrong with a cell, as its coordinator or the others tell.
std::string problem_of_cell(const cell_row& row, const cell_list& cells) {
  const auto claims = std::count_if(
      cells.cells.begin(), cells.cells.end(),
      [&](const cell_row& other) { return other.cell == row.cell; });
  if (!row.problem.empty() || claims < 2)
    return row.problem;
  return std::to_string(claims) + " coordinators claim this name";
}

std::string variable_of(const cell_row& row, const char* name) {
  const auto i = row.environment.find(name);
  return i == row.environment.end() ? "" : i->second;
}

/// A node that is in no cell has no row, so little is known of it.
registry_row unassigned_row(const unassigned_node& node,
                            const view_style& style) {
  std::vector<std::string> words;
  if (node.silent_since_unix_ms != 0)
    words.push_back("missed "
                    + format_since(node.silent_since_unix_ms, style.now_unix_ms)
                    + " ago");
  if (!node.cell.empty())
    words.push_back("it was in cell '" + node.cell + "'");
  registry_row result;
  result.identity = {node.name, node.uuid, 0, node.address};
  result.since_unix_ms = node.silent_since_unix_ms;
  result.reason = joined(words, "; ");
  return result;
}

} // namespace

std::string or_nothing(const table& t, const char* what,
                       const view_style& style) {
  return t.rows.empty() ? std::string{"no "} + what + "\n"
                        : t.render(style.text);
}

std::string cells_view(const cell_list& cells, const view_style& style) {
  table t{{{"CELL"},
           {"COORDINATOR"},
           {"NODES", align::right},
           {"ADDRESS", align::left, 2, true},
           {"DISCOVERY SERVER", align::left, 4, true},
           {"ROS_DISCOVERY_SERVER", align::left, 3, true},
           {"ROS_DOMAIN_ID", align::right, 3},
           {"TROUBLE", align::left, 1, false, true}},
          {}};
  for (const auto& row : cells.cells)
    // A coordinator counts itself, so nobody has told a size of 0.
    t.rows.push_back(
        {row.cell, row.coordinator,
         row.size == 0 ? "" : std::to_string(row.size), row.address,
         row.discovery_server, variable_of(row, "ROS_DISCOVERY_SERVER"),
         variable_of(row, "ROS_DOMAIN_ID"), problem_of_cell(row, cells)});
  return or_nothing(t, "cells", style);
}

table nodes_table(const cell_description& cell, const view_style& style) {
  auto result = table_of(node_columns(), cell.nodes, style);
  const auto put = [&](std::vector<column_value>& to, const char* name,
                       const std::string& text) {
    to.at(*column_of(result, name)) = text;
  };
  for (const auto& node : cell.free) {
    auto rows = table_of(node_columns(), {unassigned_row(node, style)}, style);
    auto& to = result.rows.emplace_back(std::move(rows.rows.front()));
    put(to, "STATE",
        node.silent_since_unix_ms != 0 ? "silent" : to_string(node.state));
    for (const auto* unknown : {"ROLE", "GPUS", "INSTANCES"})
      put(to, unknown, "");
  }
  return result;
}

std::string members_view(const cell_description& cell,
                         const view_style& style) {
  return or_nothing(nodes_table(cell, style), "nodes", style);
}

namespace {

constexpr std::string_view time_suffix = "_unix_ms";

bool is_time(std::string_view name) {
  return name.size() > time_suffix.size()
         && name.substr(name.size() - time_suffix.size()) == time_suffix;
}

json shaped_time(const json& x) {
  if (x.is_array()) {
    auto result = json::array();
    for (const auto& one : x)
      result.push_back(shaped_time(one));
    return result;
  }
  if (!x.is_number_integer() || x.get<int64_t>() == 0)
    return nullptr;
  return iso_time(x.get<int64_t>());
}

/// The text at a path of members; null if there is none.
json text_at(const json& x, std::initializer_list<const char*> path) {
  const auto* at = &x;
  for (const auto* name : path) {
    const auto found = at->is_object() ? at->find(name) : at->end();
    if (!at->is_object() || found == at->end())
      return nullptr;
    at = &*found;
  }
  return at->is_string() ? *at : json{};
}

/// What names a thing: of a node its identity, of an instance its id, and so
/// on. Null: it is none, or has its name already.
json name_of(const json& x) {
  if (x.contains("name"))
    return nullptr;
  for (const auto& path :
       {std::initializer_list<const char*>{"identity", "name"},
        {"spec", "instance"},
        {"skill", "descriptor", "operation"},
        {"descriptor", "operation"},
        {"transfer"}})
    if (auto name = text_at(x, path); !name.is_null())
      return name;
  if (x.contains("submitted_unix_ms"))
    return text_at(x, {"task"});
  if (x.contains("writers"))
    return text_at(x, {"topic"});
  return x.contains("discovery_server") ? text_at(x, {"cell"}) : json{};
}

/// `input` and `output` of a step are one end or a list of them; those of a
/// descriptor are an object of their own.
bool is_one_end(const std::string& name, const json& x) {
  return (name == "input" || name == "output") && x.is_object()
         && x.contains("endpoint");
}

/// Members in which anybody may have any names.
bool is_free_form(const std::string& name) {
  return name == "parameters" || name == "labels" || name == "environment"
         || name == "data";
}

} // namespace

json shaped(const json& reported) {
  if (reported.is_array()) {
    auto result = json::array();
    for (const auto& x : reported)
      result.push_back(shaped(x));
    return result;
  }
  if (!reported.is_object())
    return reported;
  auto result = json::object();
  if (auto name = name_of(reported); !name.is_null())
    result["name"] = std::move(name);
  for (const auto& [name, value] : reported.items()) {
    if (is_time(name))
      result[name.substr(0, name.size() - time_suffix.size())] =
          shaped_time(value);
    else if (is_one_end(name, value))
      result[name] = json::array({shaped(value)});
    else
      result[name] = is_free_form(name) ? value : shaped(value);
  }
  return result;
}

json shaped_list(const json& reply, const reply_parts& parts) {
  auto result = json::array();
  if (parts.front().empty()) {
    result.push_back(shaped(reply));
    // The name of a message is no part of a thing.
    result[0].erase("type");
  }
  for (const auto part : parts)
    if (const auto list = reply.find(std::string{part}); list != reply.end())
      for (const auto& x : *list)
        result.push_back(shaped(x));
  return result;
}

} // namespace roscell::cli
