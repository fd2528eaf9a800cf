#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// Whether the node's own discovery server knows the topics of one run of an
/// instance. What it does not know nobody else hears of, so that no data flow
/// that did not flow before. A server that has begun anew knows its programs
/// again once they have announced themselves, some seconds later. Pure: it is
/// told the time.
class server_sight {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// So long something may be missing.
  static constexpr std::chrono::seconds grace{10};

  /// `was_missed`: an earlier process of the node has said so of this run.
  explicit server_sight(bool was_missed) : misses_(was_missed) {}

  /// This of its topics is not known now: "a writer of /scene_1/image".
  void hear(std::vector<std::string> missing, time_point now);

  /// Returns true when what is to be said has changed. It is called whenever
  /// the skill has given a sign of life.
  bool judge(time_point now);

  /// One sentence without a full stop; empty: nothing is missed.
  std::string reason() const;

private:
  bool heard_ = false;
  std::vector<std::string> missing_;
  std::optional<time_point> since_;
  bool misses_;
};

} // namespace roscell
