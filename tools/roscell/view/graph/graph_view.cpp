#include "tools/roscell/view/graph/graph_view.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/drawing.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <map>
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

std::vector<std::string> box_of(const task_graph& graph, size_t i) {
  const auto& step = graph.steps[i];
  std::vector<std::string> lines{step.spec.step,
                                 step.spec.operation + " " + step.spec.model,
                                 "on " + step.node + ", " + state_text(step)};
  if (auto metrics = metrics_text(step.metrics); !metrics.empty())
    lines.push_back(std::move(metrics));
  for (const auto& x : graph.streams)
    if (x.to == i && !x.from)
      lines.push_back("in  " + x.what.endpoint);
    else if (x.from == i && !x.to)
      lines.push_back("out " + x.what.endpoint);
  for (auto& line : lines)
    line = printable(line);
  return lines;
}

std::vector<drawn_arrow> arrows_of(const task_graph& graph) {
  std::map<std::pair<size_t, size_t>, std::vector<std::string>> labels;
  for (const auto& x : graph.streams) {
    if (!x.from || !x.to)
      continue;
    const auto rate = rate_of(graph, x);
    labels[{*x.from, *x.to}].push_back(
        printable(x.what.endpoint + "  " + short_type(x.what.data_type)
                  + (rate.empty() ? "" : "  " + rate)));
  }
  std::vector<drawn_arrow> result;
  result.reserve(labels.size());
  for (auto& [ends, texts] : labels)
    result.push_back({ends.first, ends.second, std::move(texts)});
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
           {"TYPE", align::left, 3}},
          {}};
  bool any_read = false;
  for (const auto& x : graph.streams) {
    const auto* read = read_of(graph, x);
    any_read = any_read || read != nullptr;
    t.rows.push_back({x.what.endpoint, end_name(graph, x.from),
                      end_name(graph, x.to), rate_of(graph, x), x.what.protocol,
                      x.what.data_type, stream_text(read)});
  }
  // The cells of a row are cut to the number of columns.
  if (any_read)
    t.columns.push_back({"AT ITS READER", align::left, 2});
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
  std::vector<std::vector<std::string>> boxes;
  for (size_t i = 0; i < graph.steps.size(); ++i)
    boxes.push_back(box_of(graph, i));
  auto text = drawing(boxes, arrows_of(graph), width);
  if (text.empty())
    text = "too many steps stand beside each other to be drawn in "
           + std::to_string(width) + " columns\n";
  return text + "\n" + streams_view(graph, style);
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
