#include "tools/roscell/ros2/traffic_report.hpp"

#include "tools/roscell/view/format.hpp"

namespace roscell::cli {

namespace {

std::string metrics_line(const traffic_metrics& x) {
  return format_number(x.rate_hz, 2) + " Hz, gaps "
         + format_number(x.least_gap_ms, 1) + " to "
         + format_number(x.most_gap_ms, 1) + " ms (deviation "
         + format_number(x.gap_deviation_ms, 1) + "), "
         + format_bytes(x.bytes_per_s) + "/s in messages of "
         + format_bytes(x.mean_bytes) + ", " + format_number(x.median_age_ms, 2)
         + " ms old, window " + std::to_string(x.messages) + "\n";
}

json metrics_json(const traffic_metrics& x) {
  return {{"messages", x.messages},
          {"rate_hz", x.rate_hz},
          {"least_gap_ms", x.least_gap_ms},
          {"most_gap_ms", x.most_gap_ms},
          {"gap_deviation_ms", x.gap_deviation_ms},
          {"bytes_per_s", x.bytes_per_s},
          {"mean_bytes", x.mean_bytes},
          {"median_age_ms", x.median_age_ms}};
}

/// What messages are coming now; none when they have stopped.
std::optional<traffic_metrics>
present_metrics(const traffic_meter& meter,
                traffic_meter::clock::time_point now) {
  if (meter.silence(now) >= traffic_print_period)
    return std::nullopt;
  return meter.metrics();
}

} // namespace

std::string traffic_line(const traffic_meter& meter,
                         traffic_meter::clock::time_point now) {
  if (const auto x = present_metrics(meter, now))
    return metrics_line(*x);
  const auto silence =
      std::chrono::duration_cast<std::chrono::seconds>(meter.silence(now));
  if (silence < traffic_print_period)
    return "too few messages to measure\n";
  return std::string{meter.total() > 0 ? "no new message" : "no message"}
         + " for " + std::to_string(silence.count()) + " s\n";
}

json traffic_json(const traffic_meter& meter,
                  traffic_meter::clock::time_point now) {
  const auto x = present_metrics(meter, now);
  auto result = x ? metrics_json(*x) : json{{"messages", 0}};
  result["silent_s"] =
      std::chrono::duration<double>{meter.silence(now)}.count();
  return result;
}

} // namespace roscell::cli
