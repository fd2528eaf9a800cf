#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/view/graph/task_graph.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// A task's steps as boxes, what flows between them as lanes, and below them a
/// row for each stream. Where no width is given it is that of an old terminal.
std::string graph_view(const task_graph& graph, const view_style& style);

/// The same for programs: docs/operations.md has its form.
json graph_json(const task_graph& graph);

} // namespace roscell::cli
