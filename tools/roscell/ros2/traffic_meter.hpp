#pragma once

#include "messages/codec/json_codec.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace roscell::cli {

/// What has come on a topic lately.
struct traffic_metrics {
  std::size_t messages = 0;
  double rate_hz = 0;      ///< Between the first and the last of them.
  double least_gap_ms = 0; ///< Between two messages.
  double most_gap_ms = 0;
  double gap_deviation_ms = 0;
  double bytes_per_s = 0;
  double mean_bytes = 0;
  double median_age_ms = 0; ///< Since they were sent, or since their stamps.
};

/// Measures what comes on a topic, over the last messages. Told the time.
class traffic_meter {
public:
  using clock = std::chrono::steady_clock;

  /// Measures the last `most_messages` of those that come from `start` on.
  traffic_meter(std::size_t most_messages, clock::time_point start);

  void add(clock::time_point when, std::size_t bytes,
           std::chrono::nanoseconds age);

  /// Nothing before there are two messages.
  std::optional<traffic_metrics> metrics() const;

  /// How long nothing has come at `now`.
  clock::duration silence(clock::time_point now) const {
    return now - last_;
  }

  /// All that have come, those that are forgotten too.
  std::size_t total() const {
    return total_;
  }

private:
  struct arrival {
    clock::time_point when;
    std::size_t bytes;
    std::chrono::nanoseconds age;
  };

  const std::size_t most_;
  std::size_t total_ = 0;
  clock::time_point last_; ///< Arrival of the last message, else the start.
  std::deque<arrival> arrivals_;
};

/// How often a line is printed, as by `ros2 topic hz`.
inline constexpr std::chrono::seconds traffic_print_period{1};

/// The line of text about a topic at `now`: its metrics, or, when nothing came
/// for a period, how long that is. Metrics of a topic that has fallen silent
/// would read as if it went on.
std::string traffic_line(const traffic_meter& meter,
                         traffic_meter::clock::time_point now);

/// The same for programs. It has metrics while messages come, and "silent_s",
/// the time since the last message, always.
json traffic_json(const traffic_meter& meter,
                  traffic_meter::clock::time_point now);

} // namespace roscell::cli
