#include "tools/roscell/view/kept_logs_view.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

namespace roscell::cli {

namespace {

/// Its state, its exit code and why it ended.
std::string end_text(const kept_log& log) {
  std::string result{to_string(log.state)};
  if (log.exit_code >= 0)
    result += " (" + std::to_string(log.exit_code) + ')';
  return log.reason.empty() ? result : result + ": " + log.reason;
}

} // namespace

std::string kept_logs_view(const kept_logs& logs, const view_style& style) {
  table t{{{"INSTANCE"},
           {"TASK", align::left, 4, true},
           {"NODE", align::left, 3, true},
           {"ENDED", align::right},
           {"HOW", align::left, 1},
           {"SIZE", align::right, 2, true}},
          {}};
  for (const auto& x : logs.logs)
    t.rows.push_back({x.instance, x.task, x.node,
                      format_since(x.ended_unix_ms, style.now_unix_ms),
                      end_text(x), format_bytes(static_cast<double>(x.bytes))});
  auto text = or_nothing(t, "logs of instances that are gone", style);
  if (logs.unreadable > 0)
    text += std::to_string(logs.unreadable) + " more cannot be read\n";
  if (!logs.silent.empty())
    text += "without those of " + printable(joined(logs.silent, ", "))
            + ", away, silent or of an earlier version\n";
  return text;
}

} // namespace roscell::cli
