#include "tools/roscell/view/views.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <sstream>
#include <vector>

namespace roscell::cli {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);)
    result.push_back(line);
  return result;
}

std::string exit_text(int code) {
  return code < 0 ? "" : std::to_string(code);
}

} // namespace

std::string instances_view(const instance_description& instances,
                           const view_style& style) {
  table t{{{"INSTANCE"},
           {"TASK", align::left, 6, true},
           {"STEP", align::left, 5, true},
           {"NODE"},
           {"STATE"},
           {"SINCE", align::right, 2},
           {"FRAMES", align::right, 4},
           {"RATE", align::right, 1},
           {"DROPPED", align::right, 3},
           {"LATENCY", align::right, 2},
           {"DATA AGE", align::right, 2},
           {"MEMORY", align::right, 3},
           {"CPU", align::right, 4},
           {"DEPLOYMENT", align::left, 7},
           {"EXIT", align::right, 3},
           {"REMARK", align::left, 4},
           {"PID", align::right, only_wide},
           {"STREAMS", align::left, only_wide}},
          {}};
  for (const auto& row : instances.instances) {
    const auto& x = row.metrics;
    t.rows.push_back(
        {row.spec.instance, row.spec.task, row.spec.step, row.node,
         state_text(row), since_text(row, style), count_text(x.frames),
         number_with_unit(x.rate_hz, 1, " Hz"), count_text(x.dropped),
         number_with_unit(x.latency_ms, 2, " ms"),
         number_with_unit(x.age_ms, 1, " ms"), memory_text(row), cpu_text(row),
         row.spec.model + "/" + row.spec.deployment, exit_text(row.exit_code),
         remark(row, style.now_unix_ms),
         x.use.pid > 0 ? std::to_string(x.use.pid) : "", streams_text(row)});
  }
  return or_nothing(t, "instances", style);
}

std::string instance_view(const instance_description& instances,
                          const view_style& style) {
  auto text = instances_view(instances, style);
  for (const auto& row : instances.instances) {
    if (const auto words = safety_text(row); !words.empty())
      text += "\nmay be ended: " + words + "\n";
    if (row.restarts > 0)
      text += "\nstarted again " + std::to_string(row.restarts)
              + " times; its last ends:\n";
    for (const auto& end : row.ends) {
      text += "  " + format_since(end.unix_ms, style.now_unix_ms)
              + " ago: " + printable(end.reason) + "\n";
      for (const auto& line : lines_of(end.log))
        text += "      " + printable(line) + "\n";
    }
  }
  return text;
}

} // namespace roscell::cli
