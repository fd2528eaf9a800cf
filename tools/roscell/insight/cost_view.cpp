#include "tools/roscell/insight/cost_view.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table.hpp"

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
          peers_text(x)};
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
           {"PEERS (B/s)", align::left, 2}},
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

} // namespace roscell::cli
