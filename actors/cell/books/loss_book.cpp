#include "actors/cell/books/loss_book.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace roscell {

void loss_book::lose(lost_step x, std::chrono::milliseconds after) {
  x.due = x.since + after;
  x.ended_by = x.due;
  const auto instance = x.instance;
  steps_.emplace(instance, std::move(x));
}

void loss_book::lose_sight(lost_step x) {
  x.due = x.ended_by = time_point::max();
  x.is_alone = true;
  const auto instance = x.instance;
  steps_.emplace(instance, std::move(x));
}

void loss_book::see_again(const std::string& uuid) {
  for (auto i = steps_.begin(); i != steps_.end();)
    i = i->second.is_alone && i->second.uuid == uuid ? steps_.erase(i)
                                                     : std::next(i);
}

void loss_book::forget(const std::string& instance) {
  steps_.erase(instance);
}

const lost_step* loss_book::find(const std::string& instance) const {
  const auto i = steps_.find(instance);
  return i == steps_.end() ? nullptr : &i->second;
}

std::vector<lost_step> loss_book::of_task(const std::string& task) const {
  std::vector<lost_step> result;
  for (const auto& [instance, x] : steps_)
    if (x.task == task)
      result.push_back(x);
  return result;
}

bool loss_book::is_given_up(const std::string& instance) const {
  const auto* x = find(instance);
  return x && x->given_up;
}

void loss_book::give_up(const std::string& instance) {
  if (const auto i = steps_.find(instance); i != steps_.end())
    i->second.given_up = true;
}

void loss_book::postpone(const std::string& instance,
                         const std::string& trouble, time_point now) {
  const auto i = steps_.find(instance);
  if (i == steps_.end())
    return;
  auto& x = i->second;
  x.given_up = false;
  x.trouble = trouble;
  x.due = now + x.pause.next();
}

void loss_book::pause(const std::string& instance, time_point until) {
  if (const auto i = steps_.find(instance); i != steps_.end())
    i->second.due = until;
}

std::map<std::string, std::vector<lost_step>>
loss_book::due(time_point now) const {
  std::map<std::string, std::vector<lost_step>> result;
  for (const auto& [instance, x] : steps_)
    if (x.due <= now)
      result[x.task].push_back(x);
  return result;
}

loss_book::time_point loss_book::next_due() const {
  auto result = time_point::max();
  for (const auto& [instance, x] : steps_)
    result = std::min(result, x.due);
  return result;
}

} // namespace roscell
