#include "actors/cell/tasks/task_desk.hpp"

#include <algorithm>

namespace roscell {

std::chrono::steady_clock::time_point next_change_retry(const task_desk& desk) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, line] : desk.lines)
    result = std::min(result, line.retry);
  return result;
}

std::chrono::steady_clock::time_point
next_end_of_remains(const task_desk& desk) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, until] : desk.remains)
    result = std::min(result, until);
  return result;
}

std::chrono::steady_clock::time_point
next_safety_deadline(const task_desk& desk) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& x : desk.unsafe)
    result = std::min(result, x.until);
  return result;
}

} // namespace roscell
