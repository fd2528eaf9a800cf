#pragma once

#include "actors/core/backoff.hpp"

#include <chrono>
#include <map>
#include <set>
#include <string>

namespace roscell {

/// Connections to addresses that somebody has announced and nobody has proved:
/// few at a time, and ever longer pauses for whoever does not answer. Whom they
/// go to is told by a key. Pure: it opens nothing, and is told the time.
class unauthenticated_calls {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// @param limit how many calls there may be at a time.
  explicit unauthenticated_calls(size_t limit) : limit_(limit) {
    // nop
  }

  /// Takes a slot. False while none is free, the one called is being called,
  /// or its pause is not over.
  bool begin(const std::string& key, time_point now);

  /// The call came to nothing, and its slot rests for a while. True if the
  /// reason is another one than before.
  bool fail(const std::string& key, const std::string& reason, time_point now);

  /// The one called has answered. False if nobody wants to know any more.
  bool succeed(const std::string& key);

  /// There is news of the one called: its pause is over.
  void hurry(const std::string& key, time_point now);

  /// Nobody wants to call it any more. A call under way keeps its slot until it
  /// has ended.
  void forget(const std::string& key);

  bool is_running(const std::string& key) const {
    return running_.count(key) > 0;
  }

  size_t running() const {
    return running_.size();
  }

  /// How often in a row it did not answer.
  unsigned failures(const std::string& key) const;

  /// Why the last call failed; empty if it did not.
  std::string problem(const std::string& key) const;

  /// When `begin` may succeed for that key; max() while it is being called, or
  /// when only the end of another call tells.
  time_point next(const std::string& key) const;

private:
  struct history {
    time_point next;
    backoff pause;
    unsigned failures = 0;
    std::string problem;
  };

  size_t limit_;
  std::map<std::string, bool> running_; ///< Whether it is still wanted.
  std::multiset<time_point> cooling_; ///< Until when slots of ended calls rest.
  std::map<std::string, history> histories_;
};

} // namespace roscell
