#include "actors/edge/trust/invitation_table.hpp"

#include <utility>

namespace roscell {

bool invitation_table::add(open_invitation x, time_point now) {
  forget_past(now);
  if (by_id_.size() >= limits::trust::invitations)
    return false;
  const auto id = x.id;
  return by_id_.emplace(id, std::move(x)).second;
}

const open_invitation* invitation_table::find(const std::string& id,
                                              time_point now) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() || found->second.until <= now ? nullptr
                                                             : &found->second;
}

bool invitation_table::use(const std::string& id, time_point now) {
  if (find(id, now) == nullptr)
    return false;
  by_id_.erase(id);
  return true;
}

std::vector<open_invitation> invitation_table::all(time_point now) const {
  std::vector<open_invitation> result;
  for (const auto& [id, x] : by_id_)
    if (x.until > now)
      result.push_back(x);
  return result;
}

void invitation_table::forget_past(time_point now) {
  for (auto i = by_id_.begin(); i != by_id_.end();)
    i = i->second.until <= now ? by_id_.erase(i) : std::next(i);
}

} // namespace roscell
