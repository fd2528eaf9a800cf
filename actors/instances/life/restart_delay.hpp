#pragma once

#include "messages/instance.hpp"

#include <chrono>
#include <optional>
#include <string>

/// When a node starts again what has ended. Pure.
namespace roscell {

/// Numbers from a request are bounded by its schema, products of them are not:
/// at most a year.
std::chrono::milliseconds span_of(double seconds);

/// A run of an instance that has ended.
struct run_end {
  bool failed = false;              ///< Not with exit code 0.
  std::chrono::milliseconds ran{0}; ///< Since it was ready; 0: it never was.
};

/// How many attempts in a row there were before this end: 0 once the instance
/// has run for long.
int64_t attempts_before(const restart_policy& policy, const instance_row& row,
                        const run_end& end);

/// The pause before the next start, which is attempt `attempts` + 1; none if
/// there is to be no other. It is `delay_s`, then twice as long each time up to
/// `max_delay_s`, and up to a tenth more by `jitter`, 0 to 1; after the first
/// one at least `limits::instance::least_pause`.
std::optional<std::chrono::milliseconds>
restart_delay(const restart_policy& policy, const run_end& end,
              int64_t attempts, double jitter);

/// What is left of a pause that ends at `until_unix_ms`. A clock that was set
/// meanwhile makes it no longer than the longest one.
std::chrono::milliseconds rest_of_delay(const restart_policy& policy,
                                        int64_t until_unix_ms,
                                        int64_t now_unix_ms);

/// Adds an end to those that are kept, the newest first.
void keep_end(instance_row& row, ended_run end);

/// The last lines of a log, of all that is kept of it.
std::string last_lines(const std::string& log);

} // namespace roscell
