#include "tools/roscell/ros2/traffic_meter.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roscell::cli {

namespace {

using milliseconds = std::chrono::duration<double, std::milli>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<int>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

traffic_meter::traffic_meter(std::size_t most_messages, clock::time_point start)
    : most_(std::max<std::size_t>(most_messages, 2)), last_(start) {}

void traffic_meter::add(clock::time_point when, std::size_t bytes,
                        std::chrono::nanoseconds age) {
  ++total_;
  last_ = when;
  arrivals_.push_back({when, bytes, age});
  if (arrivals_.size() > most_)
    arrivals_.pop_front();
}

std::optional<traffic_metrics> traffic_meter::metrics() const {
  const milliseconds span =
      arrivals_.size() < 2 ? milliseconds{0}
                           : arrivals_.back().when - arrivals_.front().when;
  if (span <= milliseconds{0})
    return std::nullopt;
  const auto gaps = static_cast<double>(arrivals_.size() - 1);
  const double mean_gap = span.count() / gaps;
  traffic_metrics result;
  result.messages = arrivals_.size();
  result.rate_hz = 1000 / mean_gap;
  result.least_gap_ms = span.count();
  std::vector<double> ages{milliseconds{arrivals_.front().age}.count()};
  double squares = 0;
  double bytes = 0;
  for (std::size_t i = 1; i < arrivals_.size(); ++i) {
    const auto& x = arrivals_[i];
    const double gap = milliseconds{x.when - arrivals_[i - 1].when}.count();
    result.least_gap_ms = std::min(result.least_gap_ms, gap);
    result.most_gap_ms = std::max(result.most_gap_ms, gap);
    squares += (gap - mean_gap) * (gap - mean_gap);
    bytes += static_cast<double>(x.bytes);
    ages.push_back(milliseconds{x.age}.count());
  }
  result.gap_deviation_ms = std::sqrt(squares / gaps);
  result.mean_bytes = bytes / gaps;
  result.bytes_per_s = bytes / span.count() * 1000;
  result.median_age_ms = median(std::move(ages));
  return result;
}

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
