#include "actors/cell/tables/ordered_ends.hpp"

#include "actors/cell/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <iterator>

namespace roscell {

ROSCELL_CODEC(end_order)

namespace {

void make_due(ordered_end& x, ordered_end::time_point now) {
  if (x.held || x.state != order_state::ended)
    return;
  x.state = order_state::due;
  x.due = x.due_since = now;
  // Without a deadline of its own it is tried once.
  if (x.deadline == ordered_end::time_point::max())
    x.deadline = now;
}

} // namespace

void ordered_ends::add(const std::string& task, const end_order& order) {
  ordered_end x;
  x.task = task;
  x.order = order;
  ends_[order.instance] = std::move(x);
}

void ordered_ends::restore(const std::string& task, const end_order& order,
                           bool has_ended, time_point now) {
  ordered_end x;
  x.task = task;
  x.order = order;
  x.held = false;
  x.state = has_ended ? order_state::ended : order_state::asked;
  x.deadline = now + limits::task::return_of_nodes;
  make_due(x, now);
  ends_[order.instance] = std::move(x);
}

const ordered_end* ordered_ends::find(const std::string& instance) const {
  const auto i = ends_.find(instance);
  return i == ends_.end() ? nullptr : &i->second;
}

bool ordered_ends::is_asked(const std::string& instance) const {
  const auto* x = find(instance);
  return x && x->state == order_state::asked;
}

void ordered_ends::ask(const std::string& instance) {
  if (const auto i = ends_.find(instance); i != ends_.end())
    i->second.state = order_state::asked;
}

void ordered_ends::end(const std::string& instance, time_point now) {
  const auto i = ends_.find(instance);
  if (i == ends_.end() || i->second.state > order_state::ended)
    return;
  auto& x = i->second;
  x.state = order_state::ended;
  // What took long to be stop-safe is not late by that.
  if (x.deadline != time_point::max())
    x.deadline = std::max(x.deadline, now + limits::retry::longest);
  make_due(x, now);
}

void ordered_ends::let_go(const std::string& instance, time_point now,
                          std::chrono::milliseconds patience) {
  const auto i = ends_.find(instance);
  if (i == ends_.end())
    return;
  i->second.held = false;
  if (patience.count() > 0)
    i->second.deadline = now + patience;
  make_due(i->second, now);
}

void ordered_ends::let_go_of(const std::string& by, time_point now) {
  for (auto& [instance, x] : ends_)
    if (x.order.by == by) {
      x.held = false;
      make_due(x, now);
    }
}

void ordered_ends::forget(const std::string& instance) {
  ends_.erase(instance);
}

std::vector<ordered_end> ordered_ends::take_due(time_point now) {
  std::vector<ordered_end> result;
  for (auto& [instance, x] : ends_)
    if (x.state == order_state::due && x.due <= now) {
      x.state = order_state::starting;
      x.due = time_point::max();
      result.push_back(x);
    }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& x, const auto& y) {
                     return x.order.priority > y.order.priority;
                   });
  return result;
}

void ordered_ends::keep_only(const std::string& task,
                             const std::vector<end_order>& orders) {
  for (auto i = ends_.begin(); i != ends_.end();) {
    const auto is_known =
        std::any_of(orders.begin(), orders.end(),
                    [&](const auto& x) { return x.instance == i->first; });
    i = i->second.task == task && !is_known ? ends_.erase(i) : std::next(i);
  }
}

bool ordered_ends::postpone(const std::string& instance, bool is_busy,
                            time_point now) {
  const auto i = ends_.find(instance);
  if (i == ends_.end())
    return false;
  auto& x = i->second;
  const auto longest = x.due_since + limits::task::eviction;
  if (now >= (is_busy ? std::max(x.deadline, longest) : x.deadline))
    return false;
  x.state = order_state::due;
  x.due = now + x.pause.next();
  return true;
}

void ordered_ends::hurry(time_point now) {
  for (auto& [instance, x] : ends_)
    if (x.state == order_state::due)
      x.due = std::min(x.due, now);
}

ordered_ends::time_point ordered_ends::next_due() const {
  auto result = time_point::max();
  for (const auto& [instance, x] : ends_)
    result = std::min(result, x.due);
  return result;
}

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
