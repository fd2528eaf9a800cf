#include "tools/roscell/insight/insight_views.hpp"

#include "actors/edge/io/node_time.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace roscell::cli {

namespace {

constexpr double mib = 1024 * 1024;
constexpr double day_s = 24 * 3600;

/// How much it is in a second; 0 if no time has passed yet.
double rate(double amount, const cost_window& x) {
  return x.span_s > 0 ? amount / x.span_s : 0;
}

std::string rate_text(double bytes, const cost_window& x) {
  return format_number(rate(bytes, x), 1);
}

/// What a node writes at its start says nothing of a day.
std::string written_a_day(const cost_window& x) {
  constexpr double least_s = 60;
  return x.span_s < least_s ? "-"
                            : format_bytes(day_s * rate(x.written_bytes, x));
}

/// "arm 19.2/18.9, leg 19.3/19"
std::string peers_text(const cost_window& x) {
  std::vector<std::string> words;
  for (const auto& peer : x.peers)
    words.push_back(peer.peer + " " + rate_text(peer.sent_bytes, x) + "/"
                    + rate_text(peer.received_bytes, x));
  return joined(words, ", ");
}

/// "0/1048576": sent to other nodes, and fetched from them.
std::string builds_text(const cost_window& x) {
  if (x.builds_sent_bytes + x.builds_received_bytes == 0)
    return "-";
  return rate_text(x.builds_sent_bytes, x) + "/"
         + rate_text(x.builds_received_bytes, x);
}

std::vector<cell> row_of(const std::string& node, const cost_window& x) {
  double sent_bytes = 0;
  double received_bytes = 0;
  for (const auto& peer : x.peers) {
    sent_bytes += peer.sent_bytes;
    received_bytes += peer.received_bytes;
  }
  const std::chrono::milliseconds span{static_cast<int64_t>(x.span_s * 1000)};
  return {node,
          x.window,
          format_age(span),
          format_number(100 * rate(x.cpu_s, x)),
          format_memory(x.pss_bytes / mib),
          written_a_day(x),
          rate_text(sent_bytes, x),
          rate_text(received_bytes, x),
          peers_text(x),
          builds_text(x)};
}

} // namespace

std::string cost_view(const cost_report& report, const view_style& style) {
  table t{{{"NODE"},
           {"WINDOW"},
           {"SPAN", align::right, 1},
           {"CPU (%)", align::right},
           {"PSS", align::right},
           {"WRITTEN A DAY", align::right},
           {"SENT (B/s)", align::right},
           {"RECEIVED (B/s)", align::right},
           {"PEERS (B/s)", align::left, 2},
           {"BUILDS (B/s)", align::right, 3}},
          {}};
  std::string problems;
  for (const auto& node : report.nodes) {
    for (const auto& x : node.windows)
      t.rows.push_back(row_of(node.node, x));
    if (!node.problem.empty())
      problems += printable(node.node + ": " + node.problem) + "\n";
  }
  return t.render(style.text) + (problems.empty() ? "" : "\n" + problems);
}

namespace {

constexpr size_t indent_step = 2;

bool is_plain(const json& x) {
  return !x.is_structured() || x.empty();
}

std::string plain_text(const json& x) {
  if (x.is_structured())
    return "none";
  const auto text = x.is_string() ? x.get<std::string>() : x.dump();
  return text.empty() ? "-" : printable(text);
}

/// Of plain values, as one line; empty where that would be too long.
std::string one_line(const json& list) {
  constexpr size_t most_columns = 60;
  std::string result;
  for (const auto& x : list) {
    if (!is_plain(x))
      return "";
    result += (result.empty() ? "" : ", ") + plain_text(x);
  }
  return display_width(result) <= most_columns ? result : "";
}

std::string entry(const std::string& label, const json& x, size_t indent) {
  const auto begin = std::string(indent, ' ') + label;
  if (is_plain(x))
    return begin + " " + plain_text(x) + "\n";
  if (x.is_array())
    if (const auto line = one_line(x); !line.empty())
      return begin + " " + line + "\n";
  return begin + "\n" + state_text(x, indent + indent_step);
}

} // namespace

std::string state_text(const json& value, size_t indent) {
  if (is_plain(value))
    return std::string(indent, ' ') + plain_text(value) + "\n";
  std::string result;
  if (value.is_array())
    for (const auto& x : value)
      result += entry("-", x, indent);
  else
    for (const auto& [name, x] : value.items())
      result += entry(printable(name) + ":", x, indent);
  return result;
}

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
