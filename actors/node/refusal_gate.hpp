#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

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

} // namespace roscell
