#include "actors/cell/tables/slot_table.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

void slot_table::promise(const std::string& node,
                         const std::string& coordinator, time_point now) {
  by_node_[node] = {coordinator, now + limits::cell::place};
  if (by_node_.size() <= limits::cell::places)
    return;
  by_node_.erase(std::min_element(by_node_.begin(), by_node_.end(),
                                  [](const auto& x, const auto& y) {
                                    return x.second.until < y.second.until;
                                  }));
}

void slot_table::forget(const std::string& node) {
  by_node_.erase(node);
}

void slot_table::forget(const std::string& node,
                        const std::string& coordinator) {
  const auto i = by_node_.find(node);
  if (i != by_node_.end() && i->second.coordinator == coordinator)
    by_node_.erase(i);
}

std::string slot_table::find(const std::string& node, time_point now) const {
  const auto i = by_node_.find(node);
  return i == by_node_.end() || i->second.until <= now ? std::string{}
                                                       : i->second.coordinator;
}

int64_t slot_table::count_at(
    const std::string& coordinator,
    const std::function<bool(const std::string& node)>& is_counted) const {
  return std::count_if(by_node_.begin(), by_node_.end(), [&](const auto& x) {
    return x.second.coordinator == coordinator && !is_counted(x.first);
  });
}

void slot_table::drop_overdue_slots(time_point now) {
  for (auto i = by_node_.begin(); i != by_node_.end();)
    i = i->second.until <= now ? by_node_.erase(i) : std::next(i);
}

bool slot_table::await_arrival(const std::string& node, completion_handler done,
                               time_point now) {
  if (arrivals_.size() >= limits::cell::waiting)
    return false;
  arrivals_.emplace(
      node, awaited_arrival{now + limits::cell::arrival, std::move(done)});
  return true;
}

std::vector<awaited_arrival>
slot_table::take_arrivals(const std::string& node) {
  const auto [begin, end] = arrivals_.equal_range(node);
  std::vector<awaited_arrival> result;
  for (auto i = begin; i != end; ++i)
    result.push_back(std::move(i->second));
  arrivals_.erase(begin, end);
  return result;
}

std::vector<awaited_arrival> slot_table::take_overdue_arrivals(time_point now) {
  std::vector<awaited_arrival> result;
  for (auto i = arrivals_.begin(); i != arrivals_.end();) {
    if (i->second.deadline > now) {
      ++i;
      continue;
    }
    result.push_back(std::move(i->second));
    i = arrivals_.erase(i);
  }
  return result;
}

bool slot_table::await_sizes(std::function<void()> done, time_point now) {
  if (sizes_.size() >= limits::cell::waiting)
    return false;
  sizes_.push_back({now + limits::cell::sizes, std::move(done)});
  return true;
}

std::vector<awaited_sizes> slot_table::take_all_who_await_sizes() {
  std::vector<awaited_sizes> result{std::make_move_iterator(sizes_.begin()),
                                    std::make_move_iterator(sizes_.end())};
  sizes_.clear();
  return result;
}

std::vector<awaited_sizes>
slot_table::take_overdue_who_await_sizes(time_point now) {
  std::vector<awaited_sizes> result;
  while (!sizes_.empty() && sizes_.front().deadline <= now) {
    result.push_back(std::move(sizes_.front()));
    sizes_.pop_front();
  }
  return result;
}

slot_table::time_point slot_table::next_deadline() const {
  auto result = sizes_.empty() ? time_point::max() : sizes_.front().deadline;
  for (const auto& [node, x] : arrivals_)
    result = std::min(result, x.deadline);
  return result;
}

} // namespace roscell
