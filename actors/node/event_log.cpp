#include "actors/node/event_log.hpp"

#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"
#include "actors/house/watching.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using event_log_self = event_log_actor::stateful_pointer<event_log_state>;

void tell_listeners(event_log_self self, const record_event& fact) {
  auto& st = self->state;
  event x{++st.last_sequence, unix_now_ms(), fact.what, fact.subject,
          fact.data};
  for (const auto& listener : st.listeners)
    self->send(listener, x);
  st.kept.push_back(std::move(x));
  if (st.kept.size() > limits::event::kept)
    st.kept.pop_front();
}

void record(event_log_self self, const record_event& fact) {
  auto& st = self->state;
  if (st.gate.lets_through(fact.what, fact.subject, self->clock().now()))
    return tell_listeners(self, fact);
  st.timer.set(self, *st.gate.next());
}

void tell_held_back(event_log_self self) {
  auto& st = self->state;
  for (const auto& x : st.gate.take_due(self->clock().now())) {
    const json data{{"more", x.more},
                    {"message", "and " + std::to_string(x.more)
                                    + " more, not told one by one"}};
    tell_listeners(self, {x.what, x.subject, data.dump()});
  }
  if (const auto next = st.gate.next())
    st.timer.set(self, *next);
}

void subscribe(event_log_self self, const subscribe_events& wish) {
  for (const auto& x : self->state.kept)
    if (x.sequence > wish.since)
      self->send(wish.listener, x);
  watch_until_its_end(self, wish.listener);
  self->state.listeners.push_back(wish.listener);
}

kept_events since(event_log_self self, const kept_events_query& query) {
  kept_events result;
  for (const auto& x : self->state.kept)
    if (x.sequence > query.since)
      result.events.push_back(x);
  return result;
}

void forget(event_log_self self, const caf::actor_addr& gone) {
  auto& xs = self->state.listeners;
  xs.erase(std::remove_if(xs.begin(), xs.end(),
                          [&](const auto& x) { return x.address() == gone; }),
           xs.end());
}

} // namespace

event_log_actor::behavior_type event_log(event_log_self self) {
  self->set_down_handler(
      [self](const caf::down_msg& down) { forget(self, down.source); });
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"last_sequence", st.last_sequence},
                         {"kept", st.kept.size()},
                         {"listeners", st.listeners.size()}});
      },
      [self](const record_event& fact) { record(self, fact); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          tell_held_back(self);
      },
      [self](const subscribe_events& wish) { subscribe(self, wish); },
      [self](const kept_events_query& x) { return since(self, x); },
  };
}

} // namespace roscell
