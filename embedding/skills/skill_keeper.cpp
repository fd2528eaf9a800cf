#include "embedding/skills/skill_keeper.hpp"

#include "actors/core/watching.hpp"
#include "actors/instances/limits.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/engine/life/heartbeat.hpp"
#include "skills/engine/life/processing_times.hpp"

#include <caf/exit_reason.hpp>
#include <caf/sec.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <exception>
#include <utility>

namespace roscell::embedding {

namespace {

using self_pointer = skill_keeper_actor::stateful_pointer<skill_keeper_state>;

/// As the shim's of a program that an exception has ended.
constexpr int failed_code = 134;
constexpr int cannot_start_code = 2;

void end_keeper(self_pointer self, int exit_code) {
  auto& st = self->state;
  st.config.side->close();
  st.config.reports.ended(exit_code);
  self->quit();
}

/// Makes the instance's actor; what it throws, now or later, ends that actor
/// alone.
void make_skill(self_pointer self) {
  auto& st = self->state;
  auto init = [make = st.config.make,
               side = st.config.side](actor_skill_instance::pointer skill) {
    skill->set_exception_handler([side](std::exception_ptr& why) -> caf::error {
      try {
        std::rethrow_exception(why);
      } catch (...) {
        side->log("it has thrown: " + engine::current_error());
      }
      return caf::sec::runtime_error;
    });
    return make(skill, actor_skill_context{side});
  };
  st.skill = self->spawn(std::move(init));
  watch_until_its_end(self, st.skill);
}

void begin(self_pointer self) {
  auto& st = self->state;
  try {
    st.config.side->open();
  } catch (...) {
    st.config.side->log("cannot start: " + engine::current_error());
    return end_keeper(self, cannot_start_code);
  }
  make_skill(self);
}

void set_timer(self_pointer self) {
  auto& st = self->state;
  const auto next = std::min({st.life_due, st.safety_due, st.force_due});
  if (next != alarm::time_point::max())
    st.timer.set(self, next);
}

void expect_life(self_pointer self) {
  self->state.life_due =
      self->clock().now() + limits::instance::announced_watchdog / 2;
  set_timer(self);
}

void ask_life(self_pointer self) {
  auto& st = self->state;
  if (!st.skill || st.ending)
    return;
  self->request(st.skill, limits::instance::watchdog, check_life{})
      .then(
          [self] {
            instance_notified event;
            event.instance = self->state.config.instance;
            event.alive = true;
            event.status = engine::frame_text(
                *self->state.times, self->state.config.side->inbox().dropped(),
                self->state.failed);
            self->state.config.reports.notified(event);
            expect_life(self);
          },
          // The node hears nothing, and judges.
          [self](const caf::error&) { expect_life(self); });
}

void pass_on(self_pointer self);

void on_handled(self_pointer self) {
  self->state.busy = false;
  pass_on(self);
}

/// One frame at a time, so that what waits is dropped where it is bounded.
void pass_on(self_pointer self) {
  auto& st = self->state;
  if (st.busy || st.ending || !st.skill)
    return;
  auto next = st.config.side->inbox().pop();
  if (!next)
    return;
  st.busy = true;
  st.frame_begun = std::chrono::steady_clock::now();
  self->request(st.skill, limits::instance::watchdog, std::move(*next))
      .then(
          [self] {
            auto& now = self->state;
            now.times->add(std::chrono::steady_clock::now() - now.frame_begun);
            on_handled(self);
          },
          [self](const caf::error&) {
            ++self->state.failed;
            on_handled(self);
          });
}

void use_force(self_pointer self) {
  if (self->state.skill)
    self->send_exit(self->state.skill, caf::exit_reason::kill);
}

void on_ready(self_pointer self) {
  auto& st = self->state;
  if (!st.skill || st.ending)
    return;
  instance_notified event;
  event.instance = st.config.instance;
  event.ready = true;
  // Who hears that it runs knows whether it may be ended.
  event.safe = st.config.side->take_safety();
  st.config.reports.notified(event);
  try {
    st.config.side->start_inputs();
  } catch (...) {
    st.config.side->log("cannot read its inputs: " + engine::current_error());
    return use_force(self);
  }
  expect_life(self);
  pass_on(self);
}

/// An instance that changes its mind often is not heard more often. It says
/// nothing more until what it has said is taken.
void on_safety_reported(self_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  if (now < st.safety_quiet_until) {
    st.safety_due = st.safety_quiet_until;
    return set_timer(self);
  }
  st.safety_quiet_until = now + engine::heartbeat::least_word_pause;
  instance_notified event;
  event.instance = st.config.instance;
  event.safe = st.config.side->take_safety();
  st.config.reports.notified(event);
}

/// Whether what is due at this time is; if so, it is not any more.
bool take_due(alarm::time_point& due, alarm::time_point now) {
  if (now < due)
    return false;
  due = alarm::time_point::max();
  return true;
}

void on_tick(self_pointer self, uint64_t number) {
  auto& st = self->state;
  if (!st.timer.rings(number))
    return;
  const auto now = self->clock().now();
  if (take_due(st.life_due, now))
    ask_life(self);
  if (take_due(st.safety_due, now))
    on_safety_reported(self);
  if (take_due(st.force_due, now))
    use_force(self);
  set_timer(self);
}

/// Whoever has asked politely may lose his patience: the shortest grace counts.
void end(self_pointer self, std::chrono::milliseconds grace) {
  auto& st = self->state;
  if (!st.skill)
    return end_keeper(self, 0);
  const bool is_asked = std::exchange(st.ending, true);
  if (grace.count() == 0)
    return use_force(self);
  st.force_due = std::min(st.force_due, self->clock().now() + grace);
  set_timer(self);
  if (is_asked)
    return;
  self->request(st.skill, limits::instance::most_stop_grace, stop_skill{})
      .then(
          [self] {
            self->send_exit(self->state.skill, caf::exit_reason::user_shutdown);
          },
          [self](const caf::error&) { use_force(self); });
}

void on_down(self_pointer self, const caf::down_msg& down) {
  auto& st = self->state;
  st.skill = nullptr;
  const bool in_order = st.ending || !down.reason
                        || down.reason == caf::exit_reason::user_shutdown;
  end_keeper(self, in_order ? 0 : failed_code);
}

} // namespace

skill_keeper_actor::behavior_type
skill_keeper(self_pointer self, const skill_keeper_config& config) {
  self->state.config = config;
  self->state.times = std::make_unique<engine::processing_times>();
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_down(self, down); });
  return {
      [self](const state_query&) {
        return state_of({{"instance", self->state.config.instance},
                         {"busy", self->state.busy},
                         {"ending", self->state.ending}});
      },
      [self](const begin_skill&) { begin(self); },
      [self](const skill_ready&) { on_ready(self); },
      [self](const frames_waiting&) { pass_on(self); },
      [self](const safety_reported&) { on_safety_reported(self); },
      [self](const safety_wanted&) { self->state.config.side->want_safety(); },
      [self](const end_skill& x) {
        end(self, std::chrono::milliseconds{x.grace_ms});
      },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell::embedding
