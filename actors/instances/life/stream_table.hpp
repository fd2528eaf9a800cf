#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
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

} // namespace roscell
