#include "tools/roscell/view/columns.hpp"
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

const column_list<instance_row>& instance_columns() {
  using row = const instance_row&;
  using how = const view_style&;
  static const column_list<instance_row> result{
      {{"INSTANCE"}, [](row x, how) -> cell { return x.spec.instance; }},
      {{"TASK", align::left, 6, true},
       [](row x, how) -> cell { return x.spec.task; },
       "text",
       "/spec/task"},
      {{"STEP", align::left, 5, true},
       [](row x, how) -> cell { return x.spec.step; },
       "key",
       "/spec/step"},
      {{"NODE"}, [](row x, how) -> cell { return x.node; }, "text", "/node"},
      {{"STATE"},
       [](row x, how) -> cell { return state_text(x); },
       "instance_state"},
      {{"SINCE", align::right, 2},
       [](row x, how y) -> cell { return since_text(x, y); },
       "since",
       "/since_unix_ms"},
      {{"FRAMES", align::right, 4},
       [](row x, how) -> cell { return count_text(x.metrics.frames); },
       "count",
       "/figures/frames"},
      {{"RATE", align::right, 1},
       [](row x, how) -> cell {
         return number_with_unit(x.metrics.rate_hz, 1, " Hz");
       },
       "hertz",
       "/figures/rate_hz"},
      {{"DROPPED", align::right, 3},
       [](row x, how) -> cell {
         return {count_text(x.metrics.dropped),
                 x.metrics.dropped > 0 ? look::busy : look::plain};
       },
       "count",
       "/figures/dropped"},
      {{"LATENCY", align::right, 2},
       [](row x, how) -> cell {
         return number_with_unit(x.metrics.latency_ms, 2, " ms");
       },
       "milliseconds",
       "/figures/latency_ms"},
      {{"DATA AGE", align::right, 2},
       [](row x, how) -> cell {
         return number_with_unit(x.metrics.age_ms, 1, " ms");
       }},
      {{"MEMORY", align::right, 3},
       [](row x, how) -> cell {
         return {memory_text(x), takes_too_much(x) ? look::busy : look::plain};
       },
       "mebibytes",
       "/figures/use/memory_mib"},
      {{"CPU", align::right, 4},
       [](row x, how) -> cell { return cpu_text(x); },
       "number",
       "/figures/use/cpu"},
      {{"RESTARTS", align::right, 3, false, true},
       [](row x, how) -> cell {
         return x.restarts > 0 ? cell{std::to_string(x.restarts), look::busy}
                               : cell{};
       },
       "count",
       "/restarts"},
      {{"DEPLOYMENT", align::left, 7},
       [](row x, how) -> cell {
         return x.spec.model + "/" + x.spec.deployment;
       },
       "skill",
       "/spec/operation"},
      {{"EXIT", align::right, 3},
       [](row x, how) -> cell { return exit_text(x.exit_code); }},
      {{"REMARK", align::left, 4},
       [](row x, how y) -> cell { return remark(x, y.now_unix_ms); }},
      {{"PID", align::right, only_wide},
       [](row x, how) -> cell {
         return x.metrics.use.pid > 0 ? std::to_string(x.metrics.use.pid) : "";
       }},
      {{"STREAMS", align::left, only_wide},
       [](row x, how) -> cell { return streams_text(x); }},
  };
  return result;
}

std::string instances_view(const instance_description& instances,
                           const view_style& style) {
  return or_nothing(table_of(instance_columns(), instances.instances, style),
                    "instances", style);
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
