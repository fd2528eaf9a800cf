#pragma once

#include "messages/event.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// Which events are kept one by one. A program that crashes and is started
/// again without end makes the same few events each time, which would push all
/// others out. Of what happens to one subject again and again the first ones in
/// a span of time are kept; the others pass, and are counted: the count is told
/// after spans of which each is twice the one before, until one is quiet. Pure,
/// told the time.
class event_series {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Events that have passed.
  struct count {
    event last;
    uint64_t more = 0;
  };

  /// Whether `x` is to be kept. If not it is counted.
  bool keeps(const event& x, time_point now);

  /// What was counted in the spans that are over.
  std::vector<count> take_due(time_point now);

  /// What was counted and not told; all is forgotten.
  std::vector<count> take_all();

  /// Of each series that is being counted the last one: what is true now.
  std::vector<event> last_ones() const;

  /// When `take_due` has something next.
  std::optional<time_point> next() const;

private:
  struct span {
    time_point end;
    std::chrono::milliseconds length{0};
    uint64_t kept = 0;
    uint64_t passed = 0;
    event last; ///< Of those that have passed.
  };

  void forget_quiet(time_point now);

  std::map<std::pair<std::string, std::string>, span> spans_;
};

/// Which refusals are told one by one. Unauthenticated peers can provoke a
/// thousand a second, which would push every other event out of the log. Pure,
/// told the time.
class refusal_gate {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Refusals that were not told.
  struct summary {
    std::string what;
    std::string subject;
    uint64_t more = 0;
  };

  /// Whether an event is to be told now. What is no refusal always is; of
  /// refusals of one kind some in each span of time are, the others are
  /// counted.
  bool lets_through(const std::string& what, const std::string& subject,
                    time_point now);

  /// What was counted in the spans that are over.
  std::vector<summary> take_due(time_point now);

  /// When `take_due` has something next.
  std::optional<time_point> next() const;

private:
  struct span {
    time_point end;
    uint64_t reported = 0;
    uint64_t held = 0;
  };

  /// By name and, for requests, by type. We make up both, unauthenticated peers
  /// cannot.
  std::map<std::pair<std::string, std::string>, span> spans_;
};

/// How loud a log tells an event.
enum class loudness { debug, info, warning };

/// What has gone wrong is a warning; where an instance is on its way to is for
/// those who look closely.
loudness loudness_of(const event& e);

} // namespace roscell
