#include "actors/cell/state/arrivals.hpp"

#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/house/limits.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace roscell {

void await_arrival(coordinator_pointer self, const std::string& uuid,
                   std::function<void(const failure*)> done) {
  self->state.arrivals.emplace(
      uuid, awaited_arrival{self->clock().now() + limits::cell::arrival,
                            std::move(done)});
  set_timer(self);
}

void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const failure* why) {
  auto& all = self->state.arrivals;
  const auto [begin, end] = all.equal_range(uuid);
  std::vector<awaited_arrival> waiting;
  for (auto i = begin; i != end; ++i)
    waiting.push_back(i->second);
  all.erase(begin, end);
  for (const auto& x : waiting)
    x.done(why);
}

void settle_overdue_arrivals(coordinator_pointer self) {
  auto& all = self->state.arrivals;
  std::vector<awaited_arrival> overdue;
  for (auto i = all.begin(); i != all.end();) {
    if (i->second.deadline > self->clock().now()) {
      ++i;
      continue;
    }
    overdue.push_back(i->second);
    i = all.erase(i);
  }
  const failure why{error_code::unresolved,
                    "the node was told to join and has not done so in time", "",
                    "send the request again; see the events of the node"};
  for (const auto& x : overdue)
    x.done(&why);
}

std::chrono::steady_clock::time_point
next_arrival_deadline(const cell_coordinator_state& st) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [uuid, x] : st.arrivals)
    result = std::min(result, x.deadline);
  return result;
}

} // namespace roscell
