#include "actors/edge/dds/presence_table.hpp"

#include "actors/edge/dds/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// Whether both are about one coordinator, or about one other node.
bool same_subject(const announcement& x, const announcement& y) {
  return x.uuid == y.uuid
         && (x.role == "coordinator") == (y.role == "coordinator");
}

} // namespace

/// What was killed and has started again is there, though its former presence
/// ends only now. What it says is told anew, as an unauthenticated peer may
/// have claimed its UUID for a while.
presence_table::change presence_table::succession(const announcement& former,
                                                  time_point now) {
  const auto heir =
      std::find_if(known_.begin(), known_.end(), [&](const auto& x) {
        return same_subject(x.second.said, former);
      });
  if (heir == known_.end())
    return {true, former};
  heir->second.reported = now;
  return {false, heir->second.said};
}

presence_table::outcome presence_table::remember(const guid_prefix& who,
                                                 const announcement& said,
                                                 time_point now) {
  outcome result;
  const auto i = known_.find(who);
  if (i == known_.end()) {
    if (known_.size() >= limits::unauthenticated_peers::participants)
      return result;
    known_.emplace(who, entry{said, now});
    result.newcomer = true;
    result.changes.push_back({false, said});
    return result;
  }
  auto& x = i->second;
  if (x.said == said
      && now - x.reported < limits::unauthenticated_peers::retelling)
    return result;
  const auto former = std::exchange(x.said, said);
  x.reported = now;
  if (!same_subject(former, said))
    result.changes.push_back(succession(former, now));
  result.changes.push_back({false, said});
  return result;
}

std::vector<presence_table::change>
presence_table::forget(const guid_prefix& who, time_point now) {
  const auto ended = known_.extract(who);
  if (!ended)
    return {};
  return {succession(ended.mapped().said, now)};
}

} // namespace roscell
