#include "actors/membership/coordinators_seen.hpp"

#include "actors/membership/limits.hpp"

namespace roscell {

bool coordinators_seen::see(const node_presence& who) {
  const auto known = by_uuid_.find(who.uuid);
  if (known != by_uuid_.end()) {
    // What is said again is no sign that it answers now.
    if (known->second == who)
      return false;
    silent_.erase(who.uuid);
    known->second = who;
    return true;
  }
  if (by_uuid_.size() >= limits::unauthenticated_peers::slot_arbiters) {
    if (silent_.empty())
      return false;
    vanish(std::string{*silent_.rbegin()});
  }
  by_uuid_.emplace(who.uuid, who);
  return true;
}

void coordinators_seen::vanish(const std::string& uuid) {
  by_uuid_.erase(uuid);
  silent_.erase(uuid);
}

void coordinators_seen::clear() {
  by_uuid_.clear();
  silent_.clear();
}

void coordinators_seen::mark_unresponsive(const std::string& uuid) {
  if (by_uuid_.count(uuid) > 0)
    silent_.insert(uuid);
}

void coordinators_seen::forgive() {
  silent_.clear();
}

const node_presence* coordinators_seen::slot_arbiter() const {
  for (const auto& [uuid, who] : by_uuid_)
    if (silent_.count(uuid) == 0)
      return &who;
  return nullptr;
}

} // namespace roscell
