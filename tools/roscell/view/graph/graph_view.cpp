#include "tools/roscell/view/graph/graph_view.hpp"

#include "client/instance_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace roscell::cli {

namespace {

/// Where something flows at the left of the boxes.
struct lane {
  size_t top = 0; ///< The first and the last line that it leads to.
  size_t bottom = 0;
  size_t column = 0;
};

using lanes_by_key = std::map<std::string, lane>;

/// All lines of a drawing, those of frames without a key.
std::vector<drawn_line>
lines_with_frames(const std::vector<std::vector<drawn_line>>& boxes) {
  std::vector<drawn_line> result;
  for (const auto& box : boxes) {
    result.push_back({});
    result.insert(result.end(), box.begin(), box.end());
    result.push_back({});
  }
  return result;
}

lanes_by_key lanes_of(const std::vector<drawn_line>& lines) {
  lanes_by_key result;
  for (size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].key.empty())
      result.try_emplace(lines[i].key, lane{i, i, 0}).first->second.bottom = i;
  for (auto i = result.begin(); i != result.end();)
    i = i->second.top == i->second.bottom ? result.erase(i) : std::next(i);
  return result;
}

/// Gives each lane a column of its own beside others. Returns how many there
/// are.
size_t place_lanes(lanes_by_key& lanes) {
  std::vector<lane*> order;
  for (auto& [key, x] : lanes)
    order.push_back(&x);
  std::sort(order.begin(), order.end(),
            [](const lane* x, const lane* y) { return x->top < y->top; });
  std::vector<size_t> free_from; // Of each column, the line.
  for (auto* x : order) {
    const auto found =
        std::find_if(free_from.begin(), free_from.end(),
                     [&](size_t line) { return line <= x->top; });
    x->column = static_cast<size_t>(found - free_from.begin());
    if (found == free_from.end())
      free_from.push_back(0);
    free_from[x->column] = x->bottom + 1;
  }
  return free_from.size();
}

/// What stands at the left of a line; one lane passes below another.
std::string margin_of(const lanes_by_key& lanes, size_t columns, size_t number,
                      const drawn_line& line) {
  std::vector<std::string> cells(2 * columns, " ");
  for (const auto& [key, x] : lanes)
    if (number >= x.top && number <= x.bottom)
      cells[2 * x.column] = "│";
  if (const auto own = lanes.find(line.key); own != lanes.end()) {
    const auto& x = own->second;
    cells[2 * x.column] = number == x.top      ? "┌"
                          : number == x.bottom ? "└"
                                               : "├";
    std::replace(cells.begin() + static_cast<long>(2 * x.column), cells.end(),
                 std::string{" "}, std::string{"─"});
    if (line.comes_in)
      cells.back() = "▶";
  }
  return joined(cells, "");
}

std::string horizontal(size_t width) {
  std::string result;
  for (size_t i = 0; i < width; ++i)
    result += "─";
  return result;
}

/// The lines of a box in its frame, no longer than `width`.
std::vector<std::string> framed(const std::vector<drawn_line>& box,
                                size_t width) {
  size_t inner = 0;
  for (const auto& x : box)
    inner = std::max(inner, display_width(x.text));
  inner = std::min(inner, width - std::min<size_t>(width, 4));
  std::vector<std::string> result{"┌" + horizontal(inner + 2) + "┐"};
  for (const auto& x : box) {
    const auto text = shortened(x.text, inner);
    result.push_back("│ " + text + std::string(inner - display_width(text), ' ')
                     + " │");
  }
  result.push_back("└" + horizontal(inner + 2) + "┘");
  return result;
}

} // namespace

std::string drawing(const std::vector<std::vector<drawn_line>>& boxes,
                    size_t width) {
  const auto lines = lines_with_frames(boxes);
  auto lanes = lanes_of(lines);
  const auto columns = place_lanes(lanes);
  std::string result;
  size_t number = 0;
  for (const auto& box : boxes)
    for (const auto& text : framed(box, width - std::min(width, 2 * columns))) {
      result +=
          shortened(margin_of(lanes, columns, number, lines[number]) + text,
                    width)
          + "\n";
      ++number;
    }
  return result;
}

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
