#include "actors/node/refusal_pace.hpp"

#include <utility>

namespace roscell {

void refusal_pace::forget_old(time_point now) {
  for (auto i = entries_.begin(); i != entries_.end();)
    i = now - i->second.reported >= pause ? entries_.erase(i) : std::next(i);
}

size_t refusal_pace::count(const std::string& address, time_point now) {
  auto known = entries_.find(address);
  if (known == entries_.end()) {
    if (entries_.size() >= most_addresses)
      forget_old(now);
    if (entries_.size() >= most_addresses)
      return 0;
    entries_[address].reported = now;
    return 1;
  }
  auto& x = known->second;
  ++x.since;
  if (now - x.reported < pause)
    return 0;
  x.reported = now;
  return std::exchange(x.since, 0);
}

} // namespace roscell
