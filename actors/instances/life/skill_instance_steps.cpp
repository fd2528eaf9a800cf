#include "actors/instances/life/skill_instance_steps.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/limits.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "schemas/utf8.hpp"

#include <caf/send.hpp>

namespace roscell {

std::string sentence(const caf::error& error) {
  const auto why = to_failure(error);
  return why.hint.empty() ? why.message : why.message + " (" + why.hint + ")";
}

std::string log_tail_of(const caf::error& error) {
  const auto details = json::parse(to_failure(error).details, nullptr, false);
  return details.is_object() ? details.value("log_tail", "") : std::string{};
}

void record_event(skill_instance_pointer self, const event_kind& event) {
  const auto& st = self->state;
  const auto& row = st.row;
  json data{{"task", row.spec.task},
            {"step", row.spec.step},
            {"state", to_string(row.state)}};
  if (!row.reason.empty())
    data["reason"] = row.reason;
  if (row.exit_code >= 0)
    data["exit_code"] = row.exit_code;
  if (row.restarts > 0)
    data["restarts"] = row.restarts;
  if (row.state == instance_state::backing_off && row.next_start_unix_ms > 0)
    data["next_start_unix_ms"] = row.next_start_unix_ms;
  st.config.context.publish_event(event, row.spec.instance, data);
}

void report(skill_instance_pointer self) {
  self->send(self->state.config.supervisor, instance_changed{self->state.row});
}

void set_state(skill_instance_pointer self, instance_state next,
               const std::string& reason) {
  auto& st = self->state;
  ++st.phase;
  drop_change(self, "it does not run any more");
  st.deadline.reset();
  st.listening = st.was_away = st.excused = false;
  st.row.state = next;
  st.row.since_unix_ms = unix_now_ms();
  // It may quote a path, which may have any bytes.
  st.row.reason = valid_utf8(reason.substr(0, limits::instance::reason_bytes));
  record_event(self, events::instance_changed);
}

void enter(skill_instance_pointer self, instance_state next,
           const std::string& reason) {
  set_state(self, next, reason);
  report(self);
}

void limit(skill_instance_pointer self, std::chrono::milliseconds span) {
  auto& st = self->state;
  st.deadline = self->clock().now() + span;
  st.timer.set(self, *st.deadline);
}

store_record record_of(const skill_instance_state& st) {
  json value = st.row;
  if (!st.started_at.empty())
    value["address"] = st.started_at;
  if (!st.started_in.empty())
    value["boot"] = st.started_in;
  return {"instances", st.row.spec.instance,
          value.dump(-1, ' ', false, json::error_handler_t::replace)};
}

void note(skill_instance_pointer self) {
  auto& st = self->state;
  const auto context = st.config.context;
  const auto instance = st.row.spec.instance;
  st.noted_running = st.row.state == instance_state::running;
  st.noted_at = self->clock().now();
  auto record = record_of(st);
  // The program is there already: it can be ended whether this is written or
  // not.
  record.may_wait = true;
  self->request(st.config.store, limits::instance::disk, record)
      .then([](const record_stored&) {},
            [=](const caf::error& error) {
              context.publish_event(events::store_failed, instance,
                                    {{"message", valid_utf8(sentence(error))}});
            });
}

void take_down(skill_instance_pointer self, instance_state last,
               const std::string& reason, std::chrono::milliseconds grace) {
  auto& st = self->state;
  enter(self, instance_state::stopping, reason);
  // Whoever wanted it may be out of reach when the node is started again.
  if (st.farewell)
    note(self);
  ask<container_stopped>(
      self, st.config.runtime, grace + limits::instance::stop,
      stop_container{st.row.spec.instance, st.row.container, grace.count()},
      [=](const container_stopped& x) {
        self->state.row.exit_code = x.exit_code;
        conclude(self, last, reason);
      },
      [=](const caf::error& error) {
        // What may still run is not started a second time.
        self->state.farewell = reason;
        conclude(self, instance_state::failed,
                 reason + "; it could not be ended: " + sentence(error));
      });
}

namespace {

void watch(skill_instance_pointer self) {
  const auto& st = self->state;
  if (st.config.graph)
    self->send(st.config.graph, *st.endpoints);
}

} // namespace

void expect_ready(skill_instance_pointer self) {
  if (self->state.endpoints)
    watch(self);
  limit(self, limits::instance::ready);
}

void expect_life(skill_instance_pointer self) {
  if (self->state.endpoints)
    watch(self);
  else
    limit(self, limits::instance::watchdog);
}

namespace {

/// What crashes several times in so short a time is written down once: its
/// record says that it runs, and the others would tell of new starts only.
bool was_just_noted(skill_instance_pointer self) {
  constexpr std::chrono::seconds span{10};
  const auto& st = self->state;
  return st.noted_running && self->clock().now() - st.noted_at < span;
}

} // namespace

void on_running(skill_instance_pointer self) {
  auto& st = self->state;
  st.has_run = true;
  st.ready_since = self->clock().now();
  enter(self, instance_state::running);
  if (!self->state.endpoints)
    limit(self, limits::instance::watchdog);
  if (!was_just_noted(self))
    note(self);
  pass_on_when_ready(self);
}

void on_started(skill_instance_pointer self, const std::string& container) {
  auto& st = self->state;
  st.row.container = container;
  if (st.ready)
    return on_running(self);
  report(self);
  expect_ready(self);
  if (!st.noted_running)
    note(self);
}

} // namespace roscell
