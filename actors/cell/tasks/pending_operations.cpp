#include "actors/cell/tasks/pending_operations.hpp"

#include <algorithm>

namespace roscell {

std::chrono::steady_clock::time_point
next_change_retry(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, line] : pending.lines)
    result = std::min(result, line.retry);
  return result;
}

std::chrono::steady_clock::time_point
next_end_of_remains(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, until] : pending.remains)
    result = std::min(result, until);
  return result;
}

std::chrono::steady_clock::time_point
next_safety_deadline(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& x : pending.not_stop_safe)
    result = std::min(result, x.until);
  return result;
}

} // namespace roscell
