#include "tools/roscell/view/describe/page.hpp"

#include "actors/edge/io/node_time.hpp"
#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/task_graph.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

constexpr size_t indent = 2;

} // namespace

void page::put_name(const std::string& name) {
  const auto begin = name + (name.empty() ? "" : mark_);
  text_ +=
      begin
      + std::string(std::max(column_, begin.size() + 1) - begin.size(), ' ');
}

void page::detail(const std::string& name, const std::string& value) {
  if (value.empty())
    return;
  auto shown = printable(value);
  const auto how = look_of_state(shown);
  if (style_.width > column_ && !style_.tables.wide)
    shown = shortened(shown, style_.width - column_);
  line x;
  cli::put(x, shown, how);
  put_name(name);
  text_ += text_of(x, style_.colour) + "\n";
}

void page::sentence(const std::string& name, const std::string& text) {
  const auto width = style_.width > 40 ? style_.width - column_ : text.npos;
  auto rest = printable(text);
  for (auto key = name; !rest.empty(); key.clear()) {
    auto end = rest.size() <= width ? rest.size() : rest.rfind(' ', width);
    end = std::min(end, rest.size());
    put_name(key);
    text_ += rest.substr(0, end) + "\n";
    rest.erase(0, std::min(end + 1, rest.size()));
  }
}

size_t page::inner_width(size_t width) {
  return width > indent ? width - indent : width;
}

void page::put(const std::string& heading, const std::string& lines) {
  text_ += "\n" + heading + ":\n";
  for (size_t at = 0; at < lines.size();) {
    const auto end = std::min(lines.find('\n', at), lines.size());
    text_ += std::string(indent, ' ') + lines.substr(at, end - at) + "\n";
    at = end + 1;
  }
}

void page::section(const std::string& heading, const table& rows) {
  auto inner = style_;
  inner.width = inner_width(style_.width);
  put(heading, rows.rows.empty() ? "none" : rows.render(inner));
}

void page::section(const std::string& heading, const std::string& lines) {
  if (!lines.empty())
    put(heading, lines);
}

namespace {

std::vector<cell> amount_row(const std::string& name, const amount& a,
                             bool is_memory) {
  const auto put = [&](double value) {
    return is_memory ? format_memory(value) : format_number(value);
  };
  return {name, put(a.used), put(a.capacity),
          put(std::max(0.0, a.capacity - a.used))};
}

} // namespace

table resources_table(const node_resources& r) {
  table t{{{"RESOURCE"},
           {"USED", align::right},
           {"CAPACITY", align::right},
           {"FREE", align::right}},
          {}};
  t.rows.push_back(amount_row("cpu (cores)", r.cpu, false));
  t.rows.push_back(amount_row("memory", r.memory_mib, true));
  t.rows.push_back(amount_row("disk", r.disk_mib, true));
  for (const auto& gpu : r.gpus) {
    const auto name = "gpu " + std::to_string(gpu.index)
                      + (gpu.name.empty() ? "" : " " + gpu.name);
    if (r.unified_memory)
      t.rows.push_back({name + " (shares memory)"});
    else
      t.rows.push_back(amount_row(name + " memory", gpu.memory_mib, true));
  }
  return t;
}

table events_table(const std::vector<event>& events, const view_style& style) {
  table t{{{"AGE", align::right}, {"EVENT"}, {"OF", align::left, 1}, {"WHAT"}},
          {}};
  for (const auto& e : events)
    t.rows.push_back({format_since(e.time_unix_ms, style.now_unix_ms), e.what,
                      e.subject, event_particulars(e)});
  return t;
}

table instances_table(const std::vector<instance_row>& rows,
                      const view_style& style) {
  return table_of(
      picked(instance_columns(), {{"INSTANCE"},
                                  {"STEP", align::left, 2},
                                  {"NODE"},
                                  {"STATE"},
                                  {"SINCE", align::right, 1},
                                  {"RATE", align::right, 1},
                                  {"DROPPED", align::right, 3},
                                  {"LATENCY", align::right, 2},
                                  {"REMARK", align::left, 4, false, true}}),
      rows, style);
}

table ports_table(const instance_row& row) {
  table t{{{"PORT"},
           {"ENDPOINT"},
           {"PROTOCOL"},
           {"TYPE", align::left, 1},
           {"FIGURES", align::left, 2, false, true}},
          {}};
  const auto add = [&](const char* port, const io_endpoint& x,
                       const stream_count* count) {
    t.rows.push_back(
        {port, x.endpoint, x.protocol, x.data_type, stream_text(count)});
  };
  for (size_t i = 0; i < row.spec.input.size(); ++i)
    add("in", row.spec.input[i], input_count(row, i));
  for (size_t i = 0; i < row.spec.output.size(); ++i)
    add("out", row.spec.output[i], output_count(row, i));
  return t;
}

table parameters_table(const std::string& parameters) {
  table t{{{"PARAMETER"}, {"VALUE"}}, {}};
  const auto all = json::parse(parameters, nullptr, false);
  if (all.is_object())
    for (const auto& [name, value] : all.items())
      t.rows.push_back(
          {name, value.is_string() ? value.get<std::string>() : value.dump()});
  return t;
}

std::string instance_state_text(const instance_row& row,
                                const view_style& style) {
  const auto since = [&](int64_t unix_ms) {
    return format_since(unix_ms, style.now_unix_ms);
  };
  if (row.unknown_since_unix_ms != 0)
    return "unknown since " + since(row.unknown_since_unix_ms) + ", it was "
           + to_string(row.state);
  return state_text(row) + " since " + since(row.since_unix_ms);
}

std::string time_and_age_text(int64_t unix_ms, const view_style& style) {
  return unix_ms <= 0 ? ""
                      : format_since(unix_ms, style.now_unix_ms) + " ago ("
                            + local_time(unix_ms) + ")";
}

std::string deadline_text(int64_t unix_ms) {
  return unix_ms <= 0 ? ""
                      : local_time(unix_ms) + " if it still runs (timeout_s)";
}

std::string resource_request_text(const resource_request& r) {
  auto result = "cpu " + format_number(r.cpu) + ", memory "
                + format_memory(r.memory_mib) + ", disk "
                + format_memory(r.disk_mib);
  if (r.needs_gpu())
    result += ", gpu memory " + format_memory(r.gpu_memory_mib);
  return result;
}

} // namespace roscell::cli
