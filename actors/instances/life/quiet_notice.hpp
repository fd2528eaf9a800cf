#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace roscell {

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
