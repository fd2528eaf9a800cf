#include "tools/roscell/insight/trace_view.hpp"

#include "actors/edge/io/time_text.hpp"
#include "tools/roscell/view/format.hpp"

namespace roscell::cli {

namespace {

std::string heading(const request_trace& x) {
  auto text = printable(x.request);
  if (!x.subject.empty())
    text += " '" + printable(x.subject) + "'";
  text += ", " + local_time(x.came_unix_ms);
  if (x.span_us < 0)
    return text + ", is worked on\n";
  text += x.refusal.empty() ? ", done" : ", refused: " + printable(x.refusal);
  return text + " after " + span_text(x.span_us) + "\n";
}

std::string outcome_of(const trace_question& x) {
  if (x.span_us < 0)
    return "no answer yet";
  return x.refused ? "refused" : "";
}

} // namespace

std::string span_text(int64_t us) {
  constexpr int64_t ms = 1000;
  constexpr int64_t s = 1000 * ms;
  if (us < 0)
    return "-";
  if (us < ms)
    return std::to_string(us) + " us";
  const bool short_span = us < s;
  const auto value =
      static_cast<double>(us) / static_cast<double>(short_span ? ms : s);
  return format_number(value, 1) + (short_span ? " ms" : " s");
}

std::string trace_view(const request_trace& trace, const text_style& style) {
  table t{{{"AT", align::right},
           {"TOOK", align::right},
           {"HANDLER"},
           {"ASKS"},
           {"NODE"},
           {"REMARK"}},
          {}};
  for (const auto& hop : trace.hops) {
    t.rows.push_back(
        {span_text(hop.begin_us), span_text(hop.span_us), hop.handler, "", "",
         hop.dropped == 0 ? ""
                          : std::to_string(hop.dropped) + " more questions"});
    for (const auto& x : hop.asked)
      t.rows.push_back({span_text(x.begin_us), span_text(x.span_us), "",
                        x.actor, x.node, outcome_of(x)});
  }
  return heading(trace) + t.render(style);
}

} // namespace roscell::cli
