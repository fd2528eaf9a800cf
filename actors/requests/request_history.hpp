#pragma once

#include "messages/insight/request_trace.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// The latest requests of a node, hop by hop, and the latest placements that
/// were decided: what `roscell trace` and `roscell why` show. Told the time;
/// any thread may write and read. Bounded: the oldest go.
class request_history {
public:
  using time_point = std::chrono::steady_clock::time_point;
  using ticket = uint64_t; ///< Names a request; 0: none.

  static constexpr size_t max_requests = 100;
  static constexpr size_t max_hops = 32;      ///< Of one request.
  static constexpr size_t max_questions = 64; ///< Of one hop.
  /// Hops and questions of all requests but the latest: half a MiB.
  static constexpr size_t max_parts = 4096;
  static constexpr size_t max_placements = 100;
  static constexpr size_t max_placement_bytes = 1024 * 1024; ///< Of all.
  static constexpr size_t max_decision_bytes = 128 * 1024;   ///< Of one.

  /// Names a question of a request.
  struct question {
    ticket request = 0;
    size_t hop = 0;
    size_t index = 0;
  };

  ticket begin(std::string type, std::string subject, int64_t unix_ms,
               time_point now);

  /// The hop before, if any, is over.
  void enter(ticket request, std::string handler, time_point now);

  /// @param actor its id, named when somebody reads.
  /// @param node the one it speaks for; empty: this one.
  question ask(ticket request, uint64_t actor, std::string node,
               time_point now);
  void answer(const question& asked, bool refused, time_point now);

  /// @param refusal the code of its error; empty: it was done.
  void end(ticket request, std::string refusal, time_point now);

  using name_function = std::function<std::string(uint64_t actor)>;

  /// Those about the subject, or all if it is empty, the oldest first.
  std::vector<request_trace> traces(const std::string& subject,
                                    const name_function& name_of) const;

  /// Replaces an earlier one of the task.
  void decide(task_placement placement);

  std::optional<task_placement> placement(const std::string& task) const;

private:
  struct entry {
    ticket id = 0;
    time_point came;
    request_trace trace;
    std::vector<std::vector<uint64_t>> actors; ///< Of the hops' questions.
  };

  void drop_oldest_request();
  entry* find(ticket id);
  void close_hop(entry& of, time_point now);
  void trim_placements();

  mutable std::mutex mutex_;
  ticket last_ = 0;
  std::deque<entry> entries_;
  size_t parts_ = 0; ///< Hops and questions that are kept.
  std::deque<task_placement> placements_;
  size_t placement_bytes_ = 0;
};

/// Bounds the JSON of a `task_plan` or of an `error`, so that the decision on
/// a large task does not drive out all others: the last of its rejected
/// candidates go, and it says how many. What is no such JSON stays.
void shorten_decision(std::string& text, size_t most_bytes);

} // namespace roscell
