#pragma once

#include "actors/instances/life/stream_table.hpp"
#include "messages/instance.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// The metrics in a status line of the form that bundled skills send:
/// "frames=120 dropped=0 median_us=850 times_us=102000 times=119,1,0,...".
/// Words that are no metric, and metrics that cannot be read, are passed over,
/// for a status is written for people. There is no rate in it.
instance_metrics metrics_in(std::string_view status);

/// What one instance has told of itself, and how fast it has gone between its
/// last two words. Pure: it is told the time.
class skill_metrics_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Takes one status line, and what has been told with it: the counts of its
  /// streams and why nothing comes of its frames. Those that follow within half
  /// a second count as one, so that a late word makes no rate of its own.
  void hear(std::string_view status, time_point now,
            std::vector<stream_count> streams = {}, std::string remark = {});

  /// The program has been started anew: its streams begin to be quiet now.
  void begin_run() {
    streams_ = {};
  }

  const instance_metrics& known() const {
    return known_;
  }

private:
  struct count {
    int64_t frames = 0;
    time_point when;
  };

  instance_metrics known_;
  std::optional<count> counted_; ///< What the next rate is measured from.
  stream_table streams_;
};

} // namespace roscell
