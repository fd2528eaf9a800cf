#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// How the data streams of one run of an instance go, by what its skill counts.
/// Pure: it is told the time, and keeps words of a little more than ten
/// seconds.
class stream_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Over so long frames are counted to call a stream steady.
  static constexpr std::chrono::seconds window{10};

  /// So many frames in a window make a stream steady.
  static constexpr int64_t steady_frames = 3;

  /// Takes what a skill has counted, and fills in what follows from its words
  /// before: rates, and for how long each stream has been quiet or steady. A
  /// stream is quiet since the word that told its last frame, or the first one.
  /// Fewer frames than before are those of a program that began anew.
  void hear(std::vector<stream_count>& reported, time_point now);

private:
  struct word {
    int64_t frames = 0;
    time_point when;
  };

  struct stream {
    /// From the newest one that is a window old on; never empty.
    std::deque<word> words;
    int64_t frames = 0;
    time_point last_frame;
    std::optional<time_point> steady_since;
    double rate_hz = -1;

    void begin(int64_t count, time_point now);
    void go_on(int64_t count, time_point now);
    bool is_steady() const;
  };

  std::map<std::string, stream> known_; ///< By their ends, as told last.
};

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

/// When a node tells by itself that an input of an instance has had no frame,
/// and that it has one again: only its cell knows whether something was sent.
/// A stream may well be silent, so that each is told of seldom: what it costs
/// is less than a byte a second. Pure: it is told the time.
class quiet_notice {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// A writer that was started at the same moment is known to be steady by
  /// then.
  static constexpr std::chrono::seconds quiet_for{30};

  /// A stream whose silence was told is not told of again for so long.
  static constexpr std::chrono::hours pause{1};

  /// Takes what is known of the streams of an instance. True: it is to be told.
  /// Inputs that are no ROS 2 topics have no writer that could be asked.
  bool hear(const instance_row& row, time_point now);

private:
  struct notice {
    bool quiet = false; ///< As it was told last.
    std::optional<time_point> reported;
  };

  std::map<std::string, notice> inputs_; ///< By their ends.
};

} // namespace roscell
