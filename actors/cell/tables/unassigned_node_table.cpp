#include "actors/cell/tables/unassigned_node_table.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>

namespace roscell {

unassigned_node_table::unassigned_node_table()
    : calls_{limits::unauthenticated_peers::proof_calls} {
  // nop
}

unassigned_node_table::sighting
unassigned_node_table::see(const node_presence& who, time_point now) {
  silent_.erase(who.uuid);
  const auto i = by_uuid_.find(who.uuid);
  if (i == by_uuid_.end()) {
    if (by_uuid_.size() >= limits::unauthenticated_peers::unassigned_nodes)
      return sighting::ignored;
    by_uuid_.emplace(who.uuid, who);
    return sighting::appeared;
  }
  if (i->second == who)
    return sighting::repeated;
  i->second = who;
  calls_.hurry(who.uuid, now);
  return sighting::changed;
}

namespace {

unassigned_node row_of(const node_presence& who,
                       int64_t silent_since_unix_ms = 0) {
  return {who.name,
          who.uuid,
          who.address,
          who.role == "orphaned" ? node_state::orphaned
                                 : node_state::independent,
          who.cell,
          silent_since_unix_ms};
}

} // namespace

void unassigned_node_table::remember_silent(const node_presence& who,
                                            int64_t now_unix_ms) {
  if (silent_.size() >= limits::unauthenticated_peers::silent_nodes)
    silent_.erase(std::min_element(
        silent_.begin(), silent_.end(), [](const auto& x, const auto& y) {
          return x.second.silent_since_unix_ms < y.second.silent_since_unix_ms;
        }));
  silent_[who.uuid] = row_of(who, now_unix_ms);
}

bool unassigned_node_table::vanish(const node_presence& who,
                                   int64_t now_unix_ms) {
  const auto i = by_uuid_.find(who.uuid);
  if (i == by_uuid_.end() || i->second.epoch != who.epoch
      || i->second.role != who.role)
    return false;
  const auto last = i->second;
  forget(who.uuid);
  remember_silent(last, now_unix_ms);
  return true;
}

void unassigned_node_table::forget(const std::string& uuid) {
  by_uuid_.erase(uuid);
  silent_.erase(uuid);
  calls_.forget(uuid);
}

void unassigned_node_table::registered(const node_identity& who) {
  silent_.erase(who.uuid);
  const auto* known = find(who.uuid);
  if (known && known->epoch < who.epoch)
    forget(who.uuid);
}

const node_presence*
unassigned_node_table::find(const std::string& uuid) const {
  const auto i = by_uuid_.find(uuid);
  return i == by_uuid_.end() ? nullptr : &i->second;
}

const node_presence*
unassigned_node_table::find_name(const std::string& name) const {
  const node_presence* result = nullptr;
  for (const auto& [uuid, who] : by_uuid_)
    if (who.name == name && (!result || who.epoch >= result->epoch))
      result = &who;
  return result;
}

std::vector<unassigned_node> unassigned_node_table::rows() const {
  std::vector<unassigned_node> result;
  for (const auto& [uuid, who] : by_uuid_)
    result.push_back(row_of(who));
  for (const auto& [uuid, row] : silent_)
    result.push_back(row);
  return result;
}

std::vector<node_presence>
unassigned_node_table::begin_questions(const doubt& is_wanted, time_point now) {
  std::vector<node_presence> result;
  for (const auto& [uuid, who] : by_uuid_)
    if (is_wanted(who) && calls_.begin(uuid, now))
      result.push_back(who);
  return result;
}

void unassigned_node_table::question_failed(const std::string& uuid,
                                            const std::string& reason,
                                            time_point now) {
  calls_.fail(uuid, reason, now);
}

bool unassigned_node_table::question_answered(const std::string& uuid) {
  return calls_.succeed(uuid);
}

unassigned_node_table::time_point
unassigned_node_table::next_question(const doubt& is_wanted) const {
  auto result = time_point::max();
  for (const auto& [uuid, who] : by_uuid_)
    if (is_wanted(who))
      result = std::min(result, calls_.next(uuid));
  return result;
}

} // namespace roscell
