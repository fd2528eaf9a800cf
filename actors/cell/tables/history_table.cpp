#include "actors/cell/tables/history_table.hpp"

#include "actors/cell/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <cstdio>

namespace roscell {

ROSCELL_CODEC(history_record)

namespace {

constexpr auto first_events = limits::task::first_events;
constexpr auto newest_events = limits::task::newest_events;

} // namespace

std::string history_key(const std::string& task, uint64_t sequence) {
  char number[24];
  std::snprintf(number, sizeof(number), "/%012llu",
                static_cast<unsigned long long>(sequence));
  return task + number;
}

history_table::addition history_table::add(const std::string& task,
                                           event recorded) {
  auto& x = stories_[task];
  recorded.sequence = ++x.last_sequence;
  addition result{{task, recorded}, {}};
  if (x.first.size() < first_events) {
    x.first.push_back(std::move(recorded));
  } else {
    x.newest.push_back(std::move(recorded));
    if (x.newest.size() > newest_events) {
      result.dropped.push_back(history_key(task, x.newest.front().sequence));
      x.newest.pop_front();
      ++x.dropped;
    }
  }
  if (stories_.size() > limits::task::histories)
    drop_oldest_task(task, result);
  return result;
}

void history_table::drop_oldest_task(const std::string& but, addition& result) {
  const auto last = [](const story& x) {
    return x.newest.empty() ? x.first.back().time_unix_ms
                            : x.newest.back().time_unix_ms;
  };
  auto oldest = stories_.end();
  for (auto i = stories_.begin(); i != stories_.end(); ++i)
    if (i->first != but
        && (oldest == stories_.end() || last(i->second) < last(oldest->second)))
      oldest = i;
  for (const auto& x : oldest->second.first)
    result.dropped.push_back(history_key(oldest->first, x.sequence));
  for (const auto& x : oldest->second.newest)
    result.dropped.push_back(history_key(oldest->first, x.sequence));
  stories_.erase(oldest);
}

void history_table::restore(std::vector<history_record> records) {
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return a.recorded.sequence < b.recorded.sequence;
  });
  for (auto& record : records) {
    auto& x = stories_[record.task];
    const auto sequence = record.recorded.sequence;
    // What lies between is gone.
    if (sequence > x.last_sequence + 1)
      x.dropped += static_cast<int64_t>(sequence - x.last_sequence - 1);
    x.last_sequence = std::max(x.last_sequence, sequence);
    if (x.first.size() < first_events && x.newest.empty() && x.dropped == 0)
      x.first.push_back(std::move(record.recorded));
    else
      x.newest.push_back(std::move(record.recorded));
  }
}

std::optional<task_history> history_table::find(const std::string& task) const {
  const auto i = stories_.find(task);
  if (i == stories_.end())
    return std::nullopt;
  task_history result{task, i->second.first, i->second.dropped};
  result.events.insert(result.events.end(), i->second.newest.begin(),
                       i->second.newest.end());
  return result;
}

} // namespace roscell
