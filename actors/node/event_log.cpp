#include "actors/node/event_log.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "actors/node/limits.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using event_log_self = event_log_pointer;

void set_timer(event_log_self self) {
  auto& st = self->state;
  for (const auto& due : {st.gate.next(), st.series.next(), st.batch_due})
    if (due)
      st.timer.set(self, *due);
}

void keep_event(event_log_self self, event x) {
  auto& st = self->state;
  x.sequence = ++st.last_sequence;
  for (const auto& listener : st.listeners)
    self->send(listener, x);
  add_to_batch(self, x);
  st.kept.push_back(std::move(x));
  if (st.kept.size() > limits::event::kept)
    st.kept.pop_front();
}

/// Who listens knows at each moment what is true; what is kept of it is
/// counted.
void pass_event(event_log_self self, const event& x) {
  for (const auto& listener : self->state.listeners)
    self->send(listener, x);
}

void record(event_log_self self, const record_event& recorded) {
  auto& st = self->state;
  const auto now = self->clock().now();
  event x{st.last_sequence, unix_now_ms(), recorded.what, recorded.subject,
          recorded.data};
  if (st.gate.lets_through(recorded.what, recorded.subject, now)) {
    x.passing = true;
    if (st.series.keeps(x, now)) {
      x.passing = false;
      keep_event(self, std::move(x));
    } else {
      pass_event(self, x);
    }
  }
  set_timer(self);
}

/// The last event that was not kept, and how many were before it.
event counted_event(event_series::count x) {
  auto data =
      json::parse(x.last.data.empty() ? "{}" : x.last.data, nullptr, false);
  if (data.is_object()) {
    data["more"] = x.more;
    x.last.data = data.dump(-1, ' ', false, json::error_handler_t::replace);
  }
  x.last.passing = false;
  return std::move(x.last);
}

void keep_counts(event_log_self self, std::vector<event_series::count> counts) {
  for (auto& x : counts)
    keep_event(self, counted_event(std::move(x)));
}

void keep_refusals(event_log_self self) {
  for (const auto& x : self->state.gate.take_due(self->clock().now())) {
    const json data{{"more", x.more},
                    {"message", "and " + std::to_string(x.more)
                                    + " more, not published one by one"}};
    keep_event(self, {0, unix_now_ms(), x.what, x.subject, data.dump()});
  }
}

void on_alarm(event_log_self self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  keep_refusals(self);
  keep_counts(self, st.series.take_due(now));
  if (st.batch_due && *st.batch_due <= now)
    write_batch(self);
  set_timer(self);
}

/// What is in memory after `number`, and of what is only counted the present.
std::vector<event> events_after(const event_log_state& st, uint64_t number) {
  std::vector<event> result;
  for (const auto& x : st.kept)
    if (x.sequence > number)
      result.push_back(x);
  for (auto& x : st.series.last_ones())
    if (x.sequence >= number)
      result.push_back(std::move(x));
  return result;
}

void subscribe(event_log_self self, const subscribe_events& request) {
  for (auto& x : events_after(self->state, request.since))
    self->send(request.listener, std::move(x));
  watch_until_its_end(self, request.listener);
  self->state.listeners.push_back(request.listener);
}

caf::result<kept_events> read_past(event_log_self self,
                                   const past_events_query& query) {
  const auto& st = self->state;
  if (!st.history)
    return kept_events{};
  auto promise = self->make_response_promise<kept_events>();
  self->request(st.history, limits::history::disk, query)
      .then(
          [promise](kept_events& x) mutable { promise.deliver(std::move(x)); },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

void forget(event_log_self self, const caf::actor_addr& gone) {
  auto& xs = self->state.listeners;
  xs.erase(std::remove_if(xs.begin(), xs.end(),
                          [&](const auto& x) { return x.address() == gone; }),
           xs.end());
}

/// The last words of a node are written before it ends.
void end_log(event_log_self self) {
  if (std::exchange(self->state.ending, true))
    return;
  keep_counts(self, self->state.series.take_all());
  write_batch(self);
}

} // namespace

event_log_actor::behavior_type event_log(event_log_self self,
                                         const event_log_setup& setup) {
  self->state.history = setup.history;
  self->state.last_sequence = setup.first_number;
  self->set_down_handler(
      [self](const caf::down_msg& down) { forget(self, down.source); });
  self->set_exit_handler([self](const caf::exit_msg&) { end_log(self); });
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"last_sequence", st.last_sequence},
                         {"kept", st.kept.size()},
                         {"unwritten", st.unwritten.size()},
                         {"listeners", st.listeners.size()}});
      },
      [self](const record_event& recorded) { record(self, recorded); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
      [self](const subscribe_events& request) { subscribe(self, request); },
      [self](const kept_events_query& x) {
        return kept_events{events_after(self->state, x.since)};
      },
      [self](const past_events_query& x) { return read_past(self, x); },
  };
}

} // namespace roscell
