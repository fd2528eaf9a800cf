#include "actors/core/clocks.hpp"
#include "actors/instances/life/restart_delay.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "messages/event_kinds.hpp"

namespace roscell {

namespace {

using std::chrono::milliseconds;

/// As long as it is not known in which boot a program was started, its host is
/// taken to have been off: a shim writes down every other end but its own by
/// force.
bool is_of_this_boot(const skill_instance_state& st) {
  return !st.started_in.empty() && st.started_in == st.config.boot;
}

/// The coordinator can be reached, as far as is known, and wants it to go on.
bool is_kept(const skill_instance_state& st) {
  return st.config.confirmed && !st.out_of_contact;
}

/// What something outside ends again and again does not come back faster than
/// what ends by itself; after a boot there is nothing to be spared.
milliseconds pause_of(const skill_instance_state& st) {
  return st.config.adopt ? milliseconds{0}
                         : span_of(st.row.spec.life.restart.delay_s);
}

} // namespace

bool is_of_other_boot(const skill_instance_state& st) {
  return !st.started_in.empty() && !st.config.boot.empty()
         && st.started_in != st.config.boot;
}

const char* interruption_of(const skill_instance_state& st,
                            const container_adopted& found) {
  if (found.terminated)
    return ordered_to_end;
  if (found.recorded || is_of_this_boot(st))
    return nullptr;
  // Of a container that an earlier version has started its engine knows how it
  // ended; nobody knows in which boot.
  if (found.exit_code >= 0 && !is_of_other_boot(st))
    return nullptr;
  return "it was interrupted: its host has been off, or was started anew";
}

void interrupt(skill_instance_pointer self, const std::string& reason) {
  auto& st = self->state;
  // It was to go, and has gone.
  if (st.farewell)
    return conclude(self, instance_state::stopped, *st.farewell);
  st.row.interrupted_unix_ms = unix_now_ms();
  st.row.reason = reason;
  record_event(self, events::instance_interrupted);
  conclude(self, instance_state::failed, reason);
}

void await_start(skill_instance_pointer self, const std::string& reason) {
  auto& st = self->state;
  const auto pause = pause_of(st);
  const auto action = boot_action_of(st.row.spec.life);
  if (action == boot_action::stay)
    back_off(self, reason, std::nullopt,
             "waits for `roscell restart " + st.row.spec.instance + "`");
  else if (action == boot_action::start || is_kept(st))
    back_off(self, reason, pause);
  else
    back_off(self, reason, std::nullopt,
             "waits for its coordinator to want it again");
}

bool waits_for_contact(const skill_instance_state& st) {
  const auto& row = st.row;
  return row.state == instance_state::backing_off && row.next_start_unix_ms == 0
         && (row.interrupted_unix_ms == 0
             || boot_action_of(row.spec.life) == boot_action::rejoin);
}

} // namespace roscell
