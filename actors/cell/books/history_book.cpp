#include "actors/cell/books/history_book.hpp"

#include "actors/house/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <cstdio>

namespace roscell {

ROSCELL_CODEC(history_record)

namespace {

constexpr auto first_facts = limits::task::first_facts;
constexpr auto newest_facts = limits::task::newest_facts;

} // namespace

std::string history_key(const std::string& task, uint64_t sequence) {
  char number[24];
  std::snprintf(number, sizeof(number), "/%012llu",
                static_cast<unsigned long long>(sequence));
  return task + number;
}

history_book::addition history_book::add(const std::string& task, event fact) {
  auto& x = stories_[task];
  fact.sequence = ++x.last_sequence;
  addition result{{task, fact}, {}};
  if (x.first.size() < first_facts) {
    x.first.push_back(std::move(fact));
  } else {
    x.newest.push_back(std::move(fact));
    if (x.newest.size() > newest_facts) {
      result.dropped.push_back(history_key(task, x.newest.front().sequence));
      x.newest.pop_front();
      ++x.dropped;
    }
  }
  if (stories_.size() > limits::task::histories)
    drop_oldest_task(task, result);
  return result;
}

void history_book::drop_oldest_task(const std::string& but, addition& result) {
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

void history_book::restore(std::vector<history_record> records) {
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return a.fact.sequence < b.fact.sequence;
  });
  for (auto& record : records) {
    auto& x = stories_[record.task];
    const auto sequence = record.fact.sequence;
    // What lies between is gone.
    if (sequence > x.last_sequence + 1)
      x.dropped += static_cast<int64_t>(sequence - x.last_sequence - 1);
    x.last_sequence = std::max(x.last_sequence, sequence);
    if (x.first.size() < first_facts && x.newest.empty() && x.dropped == 0)
      x.first.push_back(std::move(record.fact));
    else
      x.newest.push_back(std::move(record.fact));
  }
}

std::optional<task_history> history_book::find(const std::string& task) const {
  const auto i = stories_.find(task);
  if (i == stories_.end())
    return std::nullopt;
  task_history result{task, i->second.first, i->second.dropped};
  result.events.insert(result.events.end(), i->second.newest.begin(),
                       i->second.newest.end());
  return result;
}

} // namespace roscell
