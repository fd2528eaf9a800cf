#include "actors/cell/tables/unauthenticated_calls.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>

namespace roscell {

bool unauthenticated_calls::begin(const std::string& key, time_point now) {
  cooling_.erase(cooling_.begin(), cooling_.upper_bound(now));
  if (is_running(key) || running_.size() + cooling_.size() >= limit_)
    return false;
  const auto i = histories_.find(key);
  if (i != histories_.end() && i->second.next > now)
    return false;
  running_.emplace(key, true);
  return true;
}

bool unauthenticated_calls::fail(const std::string& key,
                                 const std::string& reason, time_point now) {
  if (const auto call = running_.extract(key); !call.empty()) {
    cooling_.insert(now + limits::unauthenticated_peers::slot_pause);
    if (!call.mapped())
      return false;
  }
  const auto [i, added] = histories_.try_emplace(key);
  auto& x = i->second;
  if (added)
    x.pause = backoff{static_cast<uint32_t>(std::hash<std::string>{}(key))};
  ++x.failures;
  x.next = now + x.pause.next();
  const bool news = x.problem != reason;
  x.problem = reason;
  return news;
}

bool unauthenticated_calls::succeed(const std::string& key) {
  histories_.erase(key);
  const auto call = running_.extract(key);
  return !call.empty() && call.mapped();
}

void unauthenticated_calls::hurry(const std::string& key, time_point now) {
  if (const auto i = running_.find(key); i != running_.end())
    i->second = true;
  if (const auto i = histories_.find(key); i != histories_.end())
    i->second.next = now;
}

void unauthenticated_calls::forget(const std::string& key) {
  histories_.erase(key);
  if (const auto i = running_.find(key); i != running_.end())
    i->second = false;
}

unsigned unauthenticated_calls::failures(const std::string& key) const {
  const auto i = histories_.find(key);
  return i == histories_.end() ? 0 : i->second.failures;
}

std::string unauthenticated_calls::problem(const std::string& key) const {
  const auto i = histories_.find(key);
  return i == histories_.end() ? std::string{} : i->second.problem;
}

unauthenticated_calls::time_point
unauthenticated_calls::next(const std::string& key) const {
  if (is_running(key) || running_.size() >= limit_)
    return time_point::max();
  const auto i = histories_.find(key);
  const auto own = i == histories_.end() ? time_point{} : i->second.next;
  // The slot that rests the shortest of those that leave one free.
  const auto free_rests = limit_ - running_.size() - 1;
  if (cooling_.size() <= free_rests)
    return own;
  const auto first = static_cast<long>(cooling_.size() - free_rests - 1);
  return std::max(own, *std::next(cooling_.begin(), first));
}

} // namespace roscell
