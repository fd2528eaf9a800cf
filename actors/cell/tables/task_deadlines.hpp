#pragma once

#include "actors/core/backoff.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// When tasks that have a `timeout_s` are to have ended. Pure; told the time.
/// What of it is durable stands in the tasks' records, by the wall clock, which
/// is looked at once: what is set later there changes no deadline of this run.
///
///     [*] -- its record has a deadline --> waiting
///     waiting -- the time is over --> late: what runs of it is to be ended
///     late -- something of it still runs after a pause --> late
///     any -- its record has none: all of it has ended, or it is gone --> [*]
class task_deadlines {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// A record says so; the same again changes nothing. 0: it has none.
  void follow(const std::string& task, int64_t deadline_unix_ms,
              int64_t now_unix_ms, time_point now);

  void forget(const std::string& task);

  struct late_task {
    std::string task;
    bool is_first = false; ///< It was not late before.
  };

  /// Those that are late: at once, and then after ever longer pauses.
  std::vector<late_task> take_due(time_point now);

  /// Whether it was due once.
  bool is_late(const std::string& task) const;

  /// What is late is due now: something of it may have come back.
  void hurry(time_point now);

  /// time_point::max(): none is waited for.
  time_point next_due() const;

private:
  struct entry {
    int64_t deadline_unix_ms = 0;
    time_point due = time_point::max();
    bool is_late = false;
    backoff pause = backoff{};
  };

  std::map<std::string, entry> entries_;
};

} // namespace roscell
