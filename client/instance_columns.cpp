#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "client/value_text.hpp"

namespace roscell {

namespace {

std::string exit_text(int code) {
  return code < 0 ? "" : std::to_string(code);
}

} // namespace

const column_list<instance_row>& instance_columns() {
  using row = const instance_row&;
  using now = int64_t;
  static const column_list<instance_row> result{
      {{"INSTANCE"},
       [](row x, now) -> column_value { return x.spec.instance; }},
      {{"TASK", align::left, 6, true},
       [](row x, now) -> column_value { return x.spec.task; },
       "text",
       "/spec/task"},
      {{"STEP", align::left, 5, true},
       [](row x, now) -> column_value { return x.spec.step; },
       "key",
       "/spec/step"},
      {{"NODE"},
       [](row x, now) -> column_value { return x.node; },
       "text",
       "/node"},
      {{"STATE"},
       [](row x, now) -> column_value { return state_text(x); },
       "instance_state"},
      {{"SINCE", align::right, 2},
       [](row x, now y) -> column_value { return since_text(x, y); },
       "since",
       "/since_unix_ms"},
      {{"FRAMES", align::right, 4},
       [](row x, now) -> column_value { return count_text(x.metrics.frames); },
       "count",
       "/figures/frames"},
      {{"RATE", align::right, 1},
       [](row x, now) -> column_value {
         return number_with_unit(x.metrics.rate_hz, 1, " Hz");
       },
       "hertz",
       "/figures/rate_hz"},
      {{"DROPPED", align::right, 3},
       [](row x, now) -> column_value {
         return {count_text(x.metrics.dropped),
                 x.metrics.dropped > 0 ? look::busy : look::plain};
       },
       "count",
       "/figures/dropped"},
      {{"LATENCY", align::right, 2},
       [](row x, now) -> column_value {
         return number_with_unit(x.metrics.latency_ms, 2, " ms");
       },
       "milliseconds",
       "/figures/latency_ms"},
      {{"DATA AGE", align::right, 2},
       [](row x, now) -> column_value {
         return number_with_unit(x.metrics.age_ms, 1, " ms");
       }},
      {{"MEMORY", align::right, 3},
       [](row x, now) -> column_value {
         return {memory_text(x), takes_too_much(x) ? look::busy : look::plain};
       },
       "mebibytes",
       "/figures/use/memory_mib"},
      {{"CPU", align::right, 4},
       [](row x, now) -> column_value { return cpu_text(x); },
       "number",
       "/figures/use/cpu"},
      {{"RESTARTS", align::right, 3, false, true},
       [](row x, now) -> column_value {
         return x.restarts > 0
                    ? column_value{std::to_string(x.restarts), look::busy}
                    : column_value{};
       },
       "count",
       "/restarts"},
      {{"DEPLOYMENT", align::left, 7},
       [](row x, now) -> column_value {
         return x.spec.model + "/" + x.spec.deployment;
       },
       "skill",
       "/spec/operation"},
      {{"EXIT", align::right, 3},
       [](row x, now) -> column_value { return exit_text(x.exit_code); }},
      {{"REMARK", align::left, 4},
       [](row x, now y) -> column_value { return remark(x, y); }},
      {{"PID", align::right, only_wide},
       [](row x, now) -> column_value {
         return x.metrics.use.pid > 0 ? std::to_string(x.metrics.use.pid) : "";
       }},
      {{"STREAMS", align::left, only_wide},
       [](row x, now) -> column_value { return streams_text(x); }},
  };
  return result;
}

} // namespace roscell
