#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/view/graph/task_graph.hpp"
#include "tools/roscell/view/views.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::cli {

/// A line in a box. What goes out at one line and comes in at others has the
/// same key there; empty: nothing does.
struct drawn_line {
  std::string text;
  std::string key = {};
  bool comes_in = false;
};

/// Boxes with their lines one below the other, and at their left a lane for
/// each key, from where it goes out to where it comes in; a key that stands in
/// one line only has none. No line is longer than `width`.
std::string drawing(const std::vector<std::vector<drawn_line>>& boxes,
                    size_t width);

/// A task's steps as boxes, what flows between them as lanes, and below them a
/// row for each stream. Where no width is given it is that of an old terminal.
std::string graph_view(const task_graph& graph, const view_style& style);

/// The same for programs: docs/operations.md has its form.
json graph_json(const task_graph& graph);

} // namespace roscell::cli
