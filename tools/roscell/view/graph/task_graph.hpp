#pragma once

#include "messages/instance.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roscell::cli {

/// Data that flows from one step to another, or between a step and the outside.
struct graph_stream {
  io_endpoint what;
  std::optional<size_t> from; ///< Place of the step; nothing: outside.
  std::optional<size_t> to;
};

/// The steps of a task and what flows between them.
struct task_graph {
  std::string task;
  std::vector<instance_row> steps;
  std::vector<graph_stream> streams;
};

/// What the writer and the reader of a stream have counted of it; null if there
/// is none, or it does not tell.
const stream_count* written_of(const task_graph& graph, const graph_stream& x);
const stream_count* read_of(const task_graph& graph, const graph_stream& x);

/// An output of one step is the input of another where protocol and endpoint
/// are the same.
task_graph graph_of(const std::string& task, std::vector<instance_row> steps);

/// The graph in the languages of Graphviz and Mermaid.
std::string dot_text(const task_graph& graph);
std::string mermaid_text(const task_graph& graph);

/// "10 Hz, 0 dropped, 3.1 ms": what is known of the metrics.
std::string metrics_text(const instance_metrics& metrics);

} // namespace roscell::cli
