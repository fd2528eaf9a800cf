#include "tools/roscell/view/graph/graph_view.hpp"

#include "client/instance_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/drawing.hpp"

#include <utility>

namespace roscell::cli {

namespace {

constexpr size_t usual_width = 80;

/// "Image" of "sensor_msgs/msg/Image".
std::string short_type(const std::string& type) {
  return type.substr(type.rfind('/') + 1);
}

/// That of the output, or of its step where no output is counted by itself.
std::string rate_of(const task_graph& graph, const graph_stream& x) {
  if (!x.from)
    return {};
  const auto* written = written_of(graph, x);
  const auto rate =
      written ? written->rate_hz : graph.steps[*x.from].metrics.rate_hz;
  return number_with_unit(rate, 1, " Hz");
}

/// What joins an output with the inputs that read it.
std::string key_of(const io_endpoint& x) {
  return x.protocol + " " + x.endpoint;
}

/// "out /image  Image  10 Hz".
std::string output_text(const task_graph& graph, size_t step,
                        const io_endpoint& x) {
  const auto rate = rate_of(graph, {x, step, std::nullopt});
  return "out " + x.endpoint + "  " + short_type(x.data_type)
         + (rate.empty() ? "" : "  " + rate);
}

std::vector<drawn_line> box_of(const task_graph& graph, size_t i) {
  const auto& step = graph.steps[i];
  std::vector<drawn_line> lines{{step.spec.step},
                                {step.spec.operation + " " + step.spec.model},
                                {"on " + step.node + ", " + state_text(step)}};
  if (auto metrics = metrics_text(step.metrics); !metrics.empty())
    lines.push_back({std::move(metrics)});
  for (const auto& x : step.spec.input)
    lines.push_back({"in  " + x.endpoint, key_of(x), true});
  for (const auto& x : step.spec.output)
    lines.push_back({output_text(graph, i, x), key_of(x), false});
  for (auto& line : lines)
    line.text = printable(line.text);
  return lines;
}

std::vector<std::vector<drawn_line>> boxes_of(const task_graph& graph) {
  std::vector<std::vector<drawn_line>> result;
  for (size_t i = 0; i < graph.steps.size(); ++i)
    result.push_back(box_of(graph, i));
  return result;
}

std::string end_name(const task_graph& graph, const std::optional<size_t>& x) {
  return x ? graph.steps[*x].spec.step : "";
}

std::string streams_view(const task_graph& graph, const view_style& style) {
  table t{{{"STREAM"},
           {"FROM", align::left, 1},
           {"TO", align::left, 1},
           {"RATE", align::right, 2},
           {"PROTOCOL", align::left, 4},
           {"TYPE", align::left, 3},
           {"AT ITS READER", align::left, 2, false, true}},
          {}};
  for (const auto& x : graph.streams)
    t.rows.push_back({x.what.endpoint, end_name(graph, x.from),
                      end_name(graph, x.to), rate_of(graph, x), x.what.protocol,
                      x.what.data_type, stream_text(read_of(graph, x))});
  return t.rows.empty() ? "" : t.render(style.text);
}

json count_json(const stream_count* count) {
  return count ? json(*count) : json(nullptr);
}

json end_json(const task_graph& graph, const std::optional<size_t>& x) {
  return x ? json(graph.steps[*x].spec.step) : json(nullptr);
}

} // namespace

std::string graph_view(const task_graph& graph, const view_style& style) {
  const auto width = style.text.width == 0 ? usual_width : style.text.width;
  return drawing(boxes_of(graph), width) + "\n" + streams_view(graph, style);
}

json graph_json(const task_graph& graph) {
  json steps = json::array();
  for (const auto& x : graph.steps)
    steps.push_back({{"name", x.spec.step},
                     {"instance", x.spec.instance},
                     {"operation", x.spec.operation},
                     {"model", x.spec.model},
                     {"deployment", x.spec.deployment},
                     {"node", x.node},
                     {"state", is_unknown(x) ? "unknown" : to_string(x.state)},
                     {"figures", x.metrics}});
  json streams = json::array();
  for (const auto& x : graph.streams)
    streams.push_back({{"name", x.what.endpoint},
                       {"protocol", x.what.protocol},
                       {"data_type", x.what.data_type},
                       {"from", end_json(graph, x.from)},
                       {"to", end_json(graph, x.to)},
                       {"written", count_json(written_of(graph, x))},
                       {"read", count_json(read_of(graph, x))}});
  return {{"name", graph.task}, {"steps", steps}, {"streams", streams}};
}

} // namespace roscell::cli
