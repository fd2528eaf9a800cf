#include "actors/cell/state/arrivals.hpp"

#include "actors/cell/state/coordinator_timer.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

void await_arrival(coordinator_pointer self, const std::string& uuid,
                   completion_handler done) {
  if (self->state.slots.await_arrival(uuid, done, self->clock().now()))
    return set_timer(self);
  done(failure{error_code::conflict, "too many requests wait for nodes to join",
               "", "send the request again when some have joined"});
}

void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const completion& how) {
  for (const auto& x : self->state.slots.take_arrivals(uuid))
    x.done(how);
}

void settle_overdue_arrivals(coordinator_pointer self) {
  const failure why{error_code::unresolved,
                    "the node was told to join and has not done so in time", "",
                    "send the request again; `roscell events --since 0` on the "
                    "node shows why"};
  auto& table = self->state.slots;
  for (const auto& x : table.take_overdue_arrivals(self->clock().now()))
    x.done(why);
}

} // namespace roscell
