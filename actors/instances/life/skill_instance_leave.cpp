#include "actors/core/clocks.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/instances/life/restart_delay.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "messages/event_kinds.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using std::chrono::milliseconds;

/// Where no program runs, or none that is ready, nobody is waited for.
bool must_wait(const skill_instance_state& st) {
  return st.row.spec.life.safe_state && st.row.state == instance_state::running
         && st.row.safe != safe_word::safe;
}

bool is_waiting(const skill_instance_state& st) {
  return st.row.unsafe_since_unix_ms > 0;
}

void ask_it(skill_instance_pointer self) {
  const auto& row = self->state.row;
  self->send(self->state.config.runtime,
             ask_for_safety{row.spec.instance, row.container});
}

/// None: it is waited for without end.
void set_patience(skill_instance_pointer self, milliseconds patience) {
  if (patience.count() == 0)
    return;
  auto& st = self->state;
  st.patience = self->clock().now() + patience;
  st.timer.set(self, *st.patience);
}

/// The request outlives this process: nobody may repeat it.
void wait_for_safety(skill_instance_pointer self) {
  auto& st = self->state;
  const auto patience = span_of(st.row.spec.life.safe_timeout_s);
  st.row.unsafe_since_unix_ms = unix_now_ms();
  st.row.unsafe_until_unix_ms =
      patience.count() > 0 ? st.row.unsafe_since_unix_ms + patience.count() : 0;
  st.row.waits = "waits to be stop-safe";
  st.row.reason = *st.farewell;
  record_event(self, events::instance_awaited);
  note(self);
  report(self);
  ask_it(self);
  set_patience(self, patience);
}

void stop_waiting(skill_instance_pointer self) {
  auto& st = self->state;
  st.patience.reset();
  st.row.unsafe_since_unix_ms = st.row.unsafe_until_unix_ms = 0;
  st.row.waits.clear();
  take_down(self, instance_state::stopped, *st.farewell);
}

/// It is ending politely, and somebody does not want to wait any longer. Who
/// has asked politely hears how it ends.
void hasten(skill_instance_pointer self) {
  const auto& row = self->state.row;
  caf::anon_send(self->state.config.runtime,
                 stop_container{row.spec.instance, row.container, 0});
}

int64_t boot_now(skill_instance_pointer self) {
  return self->state.config.context.boot_now_ms(self->system());
}

bool moves_on_loss(const skill_instance_state& st) {
  return st.config.may_be_lost
         && st.row.spec.life.on_node_loss.policy == loss_action::move;
}

} // namespace

void on_stop(skill_instance_pointer self, const stop_instance& request) {
  auto& st = self->state;
  const auto state = st.row.state;
  const auto before_container = !st.config.adopt && st.row.container.empty()
                                && (state < instance_state::starting
                                    || state == instance_state::backing_off);
  if (!st.farewell)
    st.farewell = request.reason;
  if (!st.concluding && st.begun && state == instance_state::stopping
      && request.force)
    return hasten(self);
  if (st.concluding || (st.begun && state == instance_state::stopping))
    return;
  st.begun = true;
  if (before_container)
    conclude(self, instance_state::stopped, *st.farewell);
  else if (is_waiting(st) && request.force)
    stop_waiting(self);
  else if (must_wait(st) && !request.force && !is_waiting(st))
    wait_for_safety(self);
  else if (!is_waiting(st))
    take_down(self, instance_state::stopped, *st.farewell);
}

void resume_leaving(skill_instance_pointer self) {
  auto& st = self->state;
  if (!is_waiting(st))
    return;
  st.farewell = st.row.reason;
  ask_it(self);
  const auto until = st.row.unsafe_until_unix_ms;
  if (until == 0)
    return;
  // A clock that was set meanwhile makes it no longer than it was meant.
  st.patience =
      self->clock().now()
      + std::clamp(milliseconds{until - unix_now_ms()}, milliseconds{0},
                   span_of(st.row.spec.life.safe_timeout_s));
  st.timer.set(self, *st.patience);
}

namespace {

/// Where its cell is now, as far as DDS is concerned.
std::map<std::string, std::string>
place_of_cell(const skill_instance_state& st) {
  std::map<std::string, std::string> result;
  for (const auto* from : {&st.config.environment, &st.row.spec.environment})
    for (const char* name : {"ROS_DISCOVERY_SERVER", "ROS_DOMAIN_ID"})
      if (const auto i = from->find(name); i != from->end())
        result.insert(*i);
  return result;
}

/// A skill of the engine makes its connections anew, and goes on.
bool notify_program(skill_instance_pointer self) {
  auto& st = self->state;
  const auto& spec = st.row.spec;
  if (!st.config.write_environment_update
      || !st.config.write_environment_update(spec.instance, place_of_cell(st)))
    return false;
  st.ordered_at = self->clock().now();
  st.config.context.publish_event(events::instance_address_changed,
                                  spec.instance,
                                  {{"task", spec.task},
                                   {"step", spec.step},
                                   {"from", st.started_at},
                                   {"to", st.config.address}});
  st.started_at = st.config.address;
  note(self);
  return true;
}

} // namespace

void renew(skill_instance_pointer self) {
  auto& st = self->state;
  if (st.config.renewal.empty() || st.farewell || notify_program(self))
    return;
  st.renewing = true;
  if (!must_wait(st))
    return take_down(self, instance_state::failed, st.config.renewal);
  st.row.waits = "waits to be stop-safe";
  st.row.reason = st.config.renewal;
  report(self);
  ask_it(self);
  set_patience(self, span_of(st.row.spec.life.safe_timeout_s));
}

void on_safety(skill_instance_pointer self, safe_word word) {
  auto& st = self->state;
  if (word == safe_word::untold || st.concluding)
    return;
  if (std::exchange(st.row.safe, word) != word)
    report(self);
  if (word != safe_word::safe || st.row.state != instance_state::running)
    return;
  if (is_waiting(st))
    stop_waiting(self);
  else if (st.renewing)
    take_down(self, instance_state::failed, st.config.renewal);
}

void on_patience_over(skill_instance_pointer self) {
  auto& st = self->state;
  constexpr const char* late = "; it was not stop-safe in time";
  st.patience.reset();
  if (!st.farewell)
    return take_down(self, instance_state::failed, st.config.renewal + late);
  st.farewell = *st.farewell + late;
  stop_waiting(self);
}

bool may_start(skill_instance_pointer self) {
  const auto& st = self->state;
  // What is started at the last moment ends before it is ready.
  return !moves_on_loss(st)
         || (st.config.confirmed
             && fence_of(st) > boot_now(self) + limits::lease::span.count());
}

int64_t fence_of(const skill_instance_state& st) {
  if (!moves_on_loss(st))
    return 0;
  const auto after = span_of(st.row.spec.life.on_node_loss.after_s);
  // 1 is a time long ago.
  return std::max<int64_t>(1, st.config.contact_boot_ms
                                  + (after - limits::lease::span).count());
}

bool was_fenced(skill_instance_pointer self) {
  const auto& st = self->state;
  if (!moves_on_loss(st))
    return false;
  // Of one that an earlier run of the node has started it is not known.
  return st.fence_boot_ms > 0 ? boot_now(self) >= st.fence_boot_ms
                              : !st.config.confirmed;
}

void on_contact(skill_instance_pointer self, const contact_proven& event) {
  auto& st = self->state;
  const auto& kept = event.kept;
  const bool named =
      std::find(kept.begin(), kept.end(), st.row.spec.instance) != kept.end();
  // The first word after a loss tells what is wanted; the others tell nothing.
  if (std::exchange(st.out_of_contact, false) || named)
    st.config.confirmed = named;
  if (!st.config.confirmed)
    return;
  st.config.contact_boot_ms =
      std::max(st.config.contact_boot_ms, event.boot_ms);
  if (waits_for_contact(st))
    return start_again(self);
  if (!moves_on_loss(st))
    return;
  const auto fence = fence_of(st);
  if (st.row.container.empty() || fence <= st.fence_boot_ms)
    return;
  st.fence_boot_ms = fence;
  self->send(st.config.runtime,
             fence_container{st.row.spec.instance, st.row.container, fence});
}

void on_contact_lost(skill_instance_pointer self) {
  auto& st = self->state;
  st.out_of_contact = true;
  // It may have to end soon, and has this long to become stop-safe.
  if (moves_on_loss(st) && must_wait(st))
    ask_it(self);
}

} // namespace roscell
