#include "actors/cell/tables/removal_table.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>
#include <iterator>

namespace roscell {

void removal_table::add(const overdue_removal& what, time_point now) {
  const auto key = std::pair{what.node, what.instance};
  if (entries_.count(key) == 0
      && entries_.size() >= limits::task::overdue_removals)
    return;
  auto& x = entries_[key];
  x.task = what.task;
  x.due = now + x.pause.next();
}

std::vector<overdue_removal> removal_table::take_due(time_point now) {
  std::vector<overdue_removal> result;
  for (auto& [key, x] : entries_)
    if (x.due <= now) {
      x.due = time_point::max();
      result.push_back({key.first, x.task, key.second});
    }
  return result;
}

removal_table::time_point removal_table::next_due() const {
  auto result = time_point::max();
  for (const auto& [key, x] : entries_)
    result = std::min(result, x.due);
  return result;
}

void removal_table::settle(const overdue_removal& what) {
  entries_.erase({what.node, what.instance});
}

void removal_table::forget_node(const std::string& node) {
  for (auto i = entries_.begin(); i != entries_.end();)
    i = i->first.first == node ? entries_.erase(i) : std::next(i);
}

} // namespace roscell
