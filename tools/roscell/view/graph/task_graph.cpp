#include "tools/roscell/view/graph/task_graph.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

bool is_same(const io_endpoint& x, const io_endpoint& y) {
  return x.protocol == y.protocol && x.endpoint == y.endpoint;
}

bool has(const std::vector<io_endpoint>& all, const io_endpoint& what) {
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& x) { return is_same(x, what); });
}

size_t place_of(const std::vector<io_endpoint>& all, const io_endpoint& what) {
  const auto i = std::find_if(all.begin(), all.end(),
                              [&](const auto& x) { return is_same(x, what); });
  return static_cast<size_t>(i - all.begin());
}

void add_outputs(task_graph& graph, size_t from) {
  for (const auto& output : graph.steps[from].spec.output) {
    bool used = false;
    for (size_t to = 0; to < graph.steps.size(); ++to)
      if (has(graph.steps[to].spec.input, output)) {
        graph.streams.push_back({output, from, to});
        used = true;
      }
    if (!used)
      graph.streams.push_back({output, from, std::nullopt});
  }
}

/// Those that no step puts out.
void add_inputs(task_graph& graph, size_t to) {
  for (const auto& input : graph.steps[to].spec.input) {
    const bool inside =
        std::any_of(graph.steps.begin(), graph.steps.end(),
                    [&](const auto& x) { return has(x.spec.output, input); });
    if (!inside)
      graph.streams.push_back({input, std::nullopt, to});
  }
}

/// Text between quotes, in both languages.
std::string unquoted(const std::string& text) {
  auto result = printable(text);
  std::replace(result.begin(), result.end(), '"', '\'');
  std::replace(result.begin(), result.end(), '\\', '/');
  return result;
}

std::string quoted(const std::string& text) {
  return '"' + unquoted(text) + '"';
}

std::string name_of(const graph_stream& x, const std::optional<size_t>& end,
                    size_t number) {
  return end ? "s" + std::to_string(*end)
             : (x.from ? "out" : "in") + std::to_string(number);
}

std::string step_text(const instance_row& step, const char* line_end) {
  std::vector<std::string> lines{unquoted(step.spec.step),
                                 "on " + unquoted(step.node)};
  if (const auto metrics = metrics_text(step.metrics); !metrics.empty())
    lines.push_back(metrics);
  return '"' + joined(lines, line_end) + '"';
}

} // namespace

task_graph graph_of(const std::string& task, std::vector<instance_row> steps) {
  task_graph result{task, std::move(steps), {}};
  for (size_t i = 0; i < result.steps.size(); ++i) {
    add_inputs(result, i);
    add_outputs(result, i);
  }
  return result;
}

const stream_count* written_of(const task_graph& graph, const graph_stream& x) {
  if (!x.from)
    return nullptr;
  const auto& step = graph.steps[*x.from];
  return output_count(step, place_of(step.spec.output, x.what));
}

const stream_count* read_of(const task_graph& graph, const graph_stream& x) {
  if (!x.to)
    return nullptr;
  const auto& step = graph.steps[*x.to];
  return input_count(step, place_of(step.spec.input, x.what));
}

std::string metrics_text(const instance_metrics& metrics) {
  std::vector<std::string> words;
  if (metrics.rate_hz >= 0)
    words.push_back(format_number(metrics.rate_hz, 1) + " Hz");
  if (metrics.dropped >= 0)
    words.push_back(std::to_string(metrics.dropped) + " dropped");
  if (metrics.latency_ms >= 0)
    words.push_back(format_number(metrics.latency_ms, 2) + " ms");
  return joined(words, ", ");
}

std::string dot_text(const task_graph& graph) {
  auto text = "digraph " + quoted(graph.task) + " {\n  node [shape=box];\n";
  for (size_t i = 0; i < graph.steps.size(); ++i)
    text += "  s" + std::to_string(i)
            + " [label=" + step_text(graph.steps[i], "\\n") + "];\n";
  for (size_t i = 0; i < graph.streams.size(); ++i) {
    const auto& x = graph.streams[i];
    for (const auto& end : {x.from, x.to})
      if (!end)
        text += "  " + name_of(x, end, i)
                + " [shape=plaintext,label=" + quoted(x.what.endpoint) + "];\n";
    text +=
        "  " + name_of(x, x.from, i) + " -> " + name_of(x, x.to, i) + " [label="
        + quoted(x.from && x.to ? x.what.endpoint : x.what.protocol) + "];\n";
  }
  return text + "}\n";
}

std::string mermaid_text(const task_graph& graph) {
  std::string text = "flowchart TB\n";
  for (size_t i = 0; i < graph.steps.size(); ++i)
    text += "  s" + std::to_string(i) + "[" + step_text(graph.steps[i], "<br/>")
            + "]\n";
  for (size_t i = 0; i < graph.streams.size(); ++i) {
    const auto& x = graph.streams[i];
    for (const auto& end : {x.from, x.to})
      if (!end)
        text +=
            "  " + name_of(x, end, i) + "([" + quoted(x.what.endpoint) + "])\n";
    text += "  " + name_of(x, x.from, i) + " -->|"
            + quoted(x.from && x.to ? x.what.endpoint : x.what.protocol) + "| "
            + name_of(x, x.to, i) + "\n";
  }
  return text;
}

} // namespace roscell::cli
