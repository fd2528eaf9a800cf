#include "actors/node/event_log.hpp"

#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// What cannot be written is no more than what is in memory anyway.
void drop_too_many(event_log_state& st) {
  while (st.unwritten.size() > limits::event::kept)
    st.unwritten.pop_front();
}

void expect_batch(event_log_pointer self) {
  auto& st = self->state;
  if (st.batch_due)
    return;
  st.batch_due = self->clock().now() + limits::history::batch_span;
  st.timer.set(self, *st.batch_due);
}

void quit_log(event_log_pointer self) {
  if (self->state.history)
    self->send_exit(self->state.history, caf::exit_reason::user_shutdown);
  self->quit(caf::exit_reason::user_shutdown);
}

void on_batch_written(event_log_pointer self) {
  auto& st = self->state;
  st.writing = st.has_problem = false;
  if (st.ending && st.unwritten.empty())
    return quit_log(self);
  if (st.ending || st.unwritten.size() >= limits::history::batch)
    return write_batch(self);
  if (!st.unwritten.empty())
    expect_batch(self);
}

/// It is tried again with the next batch. A disk that is full is told once.
void on_batch_refused(event_log_pointer self, std::vector<event> events,
                      const caf::error& error) {
  auto& st = self->state;
  st.writing = false;
  st.unwritten.insert(st.unwritten.begin(),
                      std::make_move_iterator(events.begin()),
                      std::make_move_iterator(events.end()));
  drop_too_many(st);
  if (st.ending)
    return quit_log(self);
  expect_batch(self);
  if (std::exchange(st.has_problem, true))
    return;
  const auto why = to_failure(error);
  const json data{{"message", why.message}, {"hint", why.hint}};
  self->send(
      caf::actor_cast<event_log_actor>(self),
      record_event{std::string{events::history_failed.name}, "", data.dump()});
}

std::vector<event> take_batch(event_log_state& st) {
  const auto count =
      std::min<size_t>(st.unwritten.size(), limits::history::batch);
  const auto end = st.unwritten.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<event> result{std::make_move_iterator(st.unwritten.begin()),
                            std::make_move_iterator(end)};
  st.unwritten.erase(st.unwritten.begin(), end);
  return result;
}

} // namespace

void add_to_batch(event_log_pointer self, const event& x) {
  auto& st = self->state;
  if (!st.history)
    return;
  st.unwritten.push_back(x);
  drop_too_many(st);
  if (st.has_problem || st.unwritten.size() < limits::history::batch)
    return expect_batch(self);
  write_batch(self);
}

void write_batch(event_log_pointer self) {
  auto& st = self->state;
  if (st.writing)
    return;
  st.batch_due.reset();
  if (!st.history)
    return st.ending ? quit_log(self) : void();
  st.writing = true;
  event_batch batch{take_batch(st), false};
  batch.last = st.ending && st.unwritten.empty();
  const auto limit =
      st.ending ? limits::history::last_batch : limits::history::disk;
  self->request(st.history, limit, batch)
      .then([self](const events_written&) { on_batch_written(self); },
            [self, events = batch.events](const caf::error& why) {
              on_batch_refused(self, events, why);
            });
}

} // namespace roscell
