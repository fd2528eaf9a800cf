#include "actors/cell/tables/task_deadlines.hpp"

#include "actors/core/answer_limits.hpp"

#include <algorithm>

namespace roscell {

void task_deadlines::follow(const std::string& task, int64_t deadline_unix_ms,
                            int64_t now_unix_ms, time_point now) {
  if (deadline_unix_ms == 0)
    return forget(task);
  auto& x = entries_[task];
  if (x.deadline_unix_ms == deadline_unix_ms)
    return;
  x = entry{};
  x.deadline_unix_ms = deadline_unix_ms;
  const auto left = std::max<int64_t>(0, deadline_unix_ms - now_unix_ms);
  x.due = now + std::chrono::milliseconds{left};
}

void task_deadlines::forget(const std::string& task) {
  entries_.erase(task);
}

std::vector<task_deadlines::late_task>
task_deadlines::take_due(time_point now) {
  std::vector<late_task> result;
  for (auto& [task, x] : entries_) {
    if (x.due > now)
      continue;
    result.push_back({task, !x.is_late});
    x.is_late = true;
    // Until then the nodes have answered.
    x.due = now + limits::task::removal_answer + x.pause.next();
  }
  return result;
}

bool task_deadlines::is_late(const std::string& task) const {
  const auto i = entries_.find(task);
  return i != entries_.end() && i->second.is_late;
}

void task_deadlines::hurry(time_point now) {
  for (auto& [task, x] : entries_)
    if (x.is_late)
      x.due = now;
}

task_deadlines::time_point task_deadlines::next_due() const {
  auto result = time_point::max();
  for (const auto& [task, x] : entries_)
    result = std::min(result, x.due);
  return result;
}

} // namespace roscell
