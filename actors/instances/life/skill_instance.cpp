#include "actors/instances/life/skill_instance.hpp"

#include "actors/core/watching.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/limits.hpp"

#include <utility>

namespace roscell {

namespace {

void on_start(skill_instance_pointer self) {
  auto& st = self->state;
  if (std::exchange(st.begun, true))
    return;
  st.config.adopt ? adopt(self) : begin_anew(self);
}

void on_exited(skill_instance_pointer self, const container_exited& x) {
  auto& st = self->state;
  if (st.concluding || x.container != st.row.container)
    return;
  st.row.exit_code = x.exit_code;
  st.row.out_of_memory = x.cause == end_cause::memory;
  const auto why = end_reason_text(st.row, x.cause, x.most_memory_mib);
  if (x.terminated && st.row.state != instance_state::stopping)
    interrupt(self, ordered_to_end);
  else if (st.row.state == instance_state::running && x.exit_code == 0)
    conclude(self, instance_state::stopped, "finished");
  else if (st.row.state == instance_state::running)
    conclude(self, instance_state::failed, why);
  else if (st.row.state == instance_state::starting)
    conclude(self, instance_state::failed, why + " before it was ready");
}

std::string list_of(const std::vector<std::string>& words) {
  std::string result;
  for (const auto& x : words)
    result += (result.empty() ? "" : ", ") + x;
  return result;
}

/// Why a stock ROS 2 program is taken down.
std::string verdict_on_endpoints(const skill_instance_state& st) {
  using std::to_string;
  const bool ran = st.row.state == instance_state::running;
  const auto missing =
      st.missing.empty() ? std::string{"its endpoints"} : list_of(st.missing);
  if (ran)
    return "it runs, but for " + to_string(limits::instance::watchdog.count())
           + " s the cell has not seen " + missing;
  return "it was not ready within " + to_string(limits::instance::ready.count())
         + " s: the cell has not seen " + missing
         + "; is it a ROS 2 program, and does \"topics\" name its topics?";
}

/// Nothing was to be heard.
void judge(skill_instance_pointer self) {
  using std::to_string;
  auto& st = self->state;
  st.listening = false;
  // Where we were stopped the program may have been, too.
  if (st.was_away && !std::exchange(st.excused, true))
    return limit(self, limits::instance::pause_grace);
  if (st.endpoints)
    take_down(self, instance_state::failed, verdict_on_endpoints(st));
  else if (st.row.state == instance_state::running)
    // What hangs does not listen, so force comes at once.
    take_down(self, instance_state::failed,
              "no sign of life for "
                  + to_string(limits::instance::watchdog.count()) + " s",
              std::chrono::milliseconds{0});
  else
    take_down(self, instance_state::failed,
              "it was not ready within "
                  + to_string(limits::instance::ready.count()) + " s");
}

/// The deadline has passed. Nobody is judged before what waits at its socket
/// has been read: where this process was stopped or starved, words lie there.
void listen_before_judging(skill_instance_pointer self) {
  auto& st = self->state;
  if (st.endpoints)
    return judge(self);
  st.listening = true;
  self->send(st.config.runtime, hear_container{st.row.spec.instance});
  limit(self, limits::instance::hearing);
}

void on_alarm(skill_instance_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  if (st.patience && now >= *st.patience)
    return on_patience_over(self);
  if (st.patience)
    st.timer.set(self, *st.patience);
  if (st.change && now >= st.change->until)
    on_change_late(self);
  if (st.change)
    st.timer.set(self, st.change->until);
  if (!st.deadline)
    return;
  if (now < *st.deadline)
    return st.timer.set(self, *st.deadline);
  if (st.row.state == instance_state::backing_off)
    return start_again(self);
  st.was_away =
      st.was_away || now - *st.deadline > limits::instance::pause_tolerance;
  listen_before_judging(self);
}

/// What its endpoints say of a stock program, or whether a skill of ours is
/// known.
void on_endpoints(skill_instance_pointer self, const endpoints_missing& x) {
  auto& st = self->state;
  if (st.sight)
    return on_sight(self, x);
  st.missing = x.missing;
  if (st.concluding || !st.endpoints)
    return;
  if (st.row.state == instance_state::starting && st.missing.empty())
    on_running(self);
  else if (st.row.state == instance_state::running && st.missing.empty())
    st.deadline.reset();
  else if (st.row.state == instance_state::running && !st.deadline)
    limit(self, limits::instance::watchdog);
}

void on_sign_of_life(skill_instance_pointer self) {
  auto& st = self->state;
  st.listening = st.was_away = st.excused = false;
  limit(self, limits::instance::watchdog);
}

void on_notified(skill_instance_pointer self, const instance_notified& x) {
  auto& st = self->state;
  if (st.concluding)
    return;
  on_safety(self, x.safe);
  if (x.ready && st.row.state == instance_state::starting) {
    st.ready = true;
    // Else the runtime's answer is still on its way.
    if (!st.row.container.empty())
      return on_running(self);
  }
  if (x.alive && st.row.state == instance_state::running)
    on_sign_of_life(self);
  follow_health(self, x);
  on_change_answered(self, x);
  if (x.heard && st.listening)
    judge(self);
}

/// As far as the records of this node say.
bool has_run_before(const instance_row& row) {
  return row.restarts > 0 || row.state >= instance_state::running;
}

json describe(const skill_instance_state& st) {
  return {{"instance", st.row.spec.instance},
          {"task", st.row.spec.task},
          {"state", to_string(st.row.state)},
          {"container", st.row.container},
          {"phase", st.phase}};
}

} // namespace

skill_instance_actor::behavior_type
skill_instance(skill_instance_pointer self,
               const skill_instance_config& config) {
  self->state.config = config;
  self->state.adopting = config.adopt;
  self->state.row = config.row;
  self->state.has_run = has_run_before(config.row);
  self->state.started_at = config.started_at;
  self->state.started_in = config.started_in;
  watch_until_own_end(self, config.supervisor);
  // The program goes on, and the next supervisor adopts it.
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [self](const start_instance&) { on_start(self); },
      [self](const stop_instance& x) { on_stop(self, x); },
      [self](const container_exited& x) { on_exited(self, x); },
      [self](const instance_notified& x) { on_notified(self, x); },
      [self](const endpoints_missing& x) { on_endpoints(self, x); },
      [self](const contact_proven& x) { on_contact(self, x); },
      [self](const contact_lost&) { on_contact_lost(self); },
      [self](const use_environment& x) { on_place(self, x); },
      [self](const set_parameters& x) { return take_parameters(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
