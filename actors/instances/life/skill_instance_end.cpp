#include "actors/core/clocks.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/life/restart_delay.hpp"
#include "actors/instances/life/skill_instance_steps.hpp"
#include "actors/instances/limits.hpp"
#include "schemas/utf8.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <random>
#include <string_view>

namespace roscell {

namespace {

using std::chrono::milliseconds;

void finish(skill_instance_pointer self, instance_state last,
            const std::string& reason) {
  set_state(self, last, reason);
  auto record = record_of(self->state);
  record.may_wait = true;
  // Before the report, after which the supervisor may remove the record.
  // Without a sender: nobody is left to read the answer.
  caf::anon_send(self->state.config.store, record);
  report(self);
  self->quit();
}

/// Different for each instance, so that those of one node, which may all have
/// ended with their engine, do not come back at once.
double jitter_of(const instance_row& row) {
  std::minstd_rand random{static_cast<uint32_t>(
      std::hash<std::string>{}(row.spec.instance) + row.restarts)};
  return std::uniform_real_distribution<double>{0, 1}(random);
}

/// Nothing of a run that is over counts for the next one.
void forget_run(skill_instance_state& st) {
  st.config.adopt = false;
  st.concluding = st.ready = st.renewing = st.awaits_place = false;
  st.ready_since.reset();
  st.ordered_at.reset();
  st.endpoints.reset();
  st.missing.clear();
  st.fence_boot_ms = 0;
  st.works_with_spec = true;
  st.passes_on_when_ready = false;
  st.row.container.clear();
  st.row.status.clear();
  st.row.safe = safe_word::untold;
  forget_health(st);
}

run_end end_of(skill_instance_pointer self, instance_state last) {
  const auto& since = self->state.ready_since;
  run_end result;
  result.failed = last == instance_state::failed;
  if (since)
    result.ran =
        std::chrono::duration_cast<milliseconds>(self->clock().now() - *since);
  return result;
}

void keep_run(instance_row& row, const std::string& reason,
              const std::string& log) {
  keep_end(row, {unix_now_ms(), row.exit_code, reason, last_lines(log)});
}

/// A program that ends before it is ready has said why in its last line.
std::string with_last_word(const instance_row& row, const std::string& reason,
                           const std::string& log) {
  constexpr size_t most_bytes = 300;
  const auto end = log.find_last_not_of(" \r\n");
  if (row.state != instance_state::starting || row.exit_code <= 0
      || end == std::string::npos)
    return reason;
  const auto before = log.rfind('\n', end);
  const auto begin = before == std::string::npos ? 0 : before + 1;
  return reason + ": "
         + valid_utf8(log.substr(begin, std::min(end + 1 - begin, most_bytes)));
}

/// What could not go on when it was told of another address ends with an error,
/// or hangs, and is no worse off than what cannot be told.
bool failed_when_ordered(skill_instance_pointer self, const run_end& end) {
  const auto& reported = self->state.ordered_at;
  return end.failed && reported
         && self->clock().now() - *reported < 2 * limits::instance::watchdog;
}

void back_to_cell(skill_instance_pointer self, const std::string& reason) {
  back_off(self, reason, std::nullopt,
           "waits for its node to be back in its cell");
}

/// What a log has of the last run: its shim says where one begins.
std::string of_last_run(const std::string& log) {
  constexpr std::string_view mark = "[shim: started again]\n";
  const auto at = log.rfind(mark);
  return at == std::string::npos || (at > 0 && log[at - 1] != '\n')
             ? log
             : log.substr(at + mark.size());
}

void go_on(skill_instance_pointer self, instance_state last,
           const std::string& reason, const std::string& log) {
  auto& st = self->state;
  auto& row = st.row;
  const auto& policy = row.spec.life.restart;
  const auto end = end_of(self, last);
  if (row.interrupted_unix_ms > 0) {
    keep_run(row, reason, log);
    return await_start(self, reason);
  }
  if ((st.renewing || failed_when_ordered(self, end)) && !st.farewell) {
    keep_run(row, reason, log);
    return back_off(self, reason, milliseconds{0});
  }
  if (!st.farewell && st.has_run) {
    row.attempts = attempts_before(policy, row, end);
    const auto pause = restart_delay(policy, end, row.attempts, jitter_of(row));
    if (pause || was_fenced(self)) {
      keep_run(row, reason, log);
      return was_fenced(self) ? back_to_cell(self, reason)
                              : back_off(self, reason, pause);
    }
  }
  if (end.failed)
    row.log_tail = last_bytes(log, limits::instance::log_tail_bytes);
  const bool gave_up = end.failed && row.attempts > 0 && !st.farewell;
  finish(self, last,
         gave_up ? reason + ", after " + std::to_string(row.attempts)
                       + " new starts in a row"
                 : reason);
}

/// A node that is started again within so short a pause finds that the program
/// has ended by itself, and how, in what its shim has written: a record of the
/// pause would be one more thing written each time.
bool goes_without_saying(const skill_instance_state& st,
                         const std::optional<milliseconds>& pause) {
  constexpr milliseconds short_pause{60'000};
  return st.noted_running && st.row.state != instance_state::stopping && pause
         && *pause < short_pause && st.row.interrupted_unix_ms == 0;
}

} // namespace

void back_off(skill_instance_pointer self, const std::string& reason,
              std::optional<milliseconds> pause, const std::string& waits) {
  auto& st = self->state;
  forget_run(st);
  st.row.next_start_unix_ms = pause ? unix_now_ms() + pause->count() : 0;
  st.row.waits = waits;
  const bool noted = !goes_without_saying(st, pause);
  enter(self, instance_state::backing_off, reason);
  if (noted)
    note(self);
  if (pause)
    limit(self, *pause);
}

void conclude(skill_instance_pointer self, instance_state last,
              const std::string& reason) {
  auto& st = self->state;
  ++st.phase;
  st.deadline.reset();
  st.patience.reset();
  st.concluding = true;
  st.awaits_place = false;
  drop_secrets(self);
  st.row.unsafe_since_unix_ms = st.row.unsafe_until_unix_ms = 0;
  st.row.waits.clear();
  const auto always = st.row.spec.life.restart.policy == restart_when::always;
  if (last == instance_state::stopped && (st.farewell || !always))
    return finish(self, last, reason);
  // That of a build is there already.
  if (!st.row.log_tail.empty())
    return go_on(self, last, reason, std::string{st.row.log_tail});
  log_query query;
  query.instance = st.row.spec.instance;
  ask<log_excerpt>(
      self, st.config.runtime, limits::instance::disk, query,
      [=](const log_excerpt& excerpt) {
        const auto log = of_last_run(excerpt.text);
        go_on(self, last, with_last_word(self->state.row, reason, log), log);
      },
      [=](const caf::error&) { go_on(self, last, reason, ""); });
}

void resume_pause(skill_instance_pointer self) {
  auto& st = self->state;
  ++st.phase;
  const auto until = st.row.next_start_unix_ms;
  if (until == 0)
    return st.row.interrupted_unix_ms > 0 ? await_start(self, st.row.reason)
                                          : wait_for_contact(self);
  report(self);
  limit(self, rest_of_delay(st.row.spec.life.restart, until, unix_now_ms()));
}

void wait_for_contact(skill_instance_pointer self) {
  auto& st = self->state;
  const auto reason = st.row.reason.empty()
                          ? "its node has not heard of its cell"
                          : st.row.reason;
  back_to_cell(self, reason);
}

void start_again(skill_instance_pointer self) {
  auto& st = self->state;
  if (!may_start(self))
    return wait_for_contact(self);
  ++st.row.restarts;
  if (std::exchange(st.row.interrupted_unix_ms, 0) == 0)
    ++st.row.attempts;
  st.row.next_start_unix_ms = 0;
  st.row.waits.clear();
  st.row.exit_code = -1;
  st.row.out_of_memory = false;
  st.row.log_tail.clear();
  enter(self, instance_state::pending, st.row.reason);
  ask<container_removed>(
      self, st.config.runtime, limits::instance::cleaning,
      remove_container{st.row.spec.instance, {}, true, {about_log_of(st.row)}},
      [=](const container_removed&) { build(self); },
      [=](const caf::error& error) {
        conclude(self, instance_state::failed,
                 "what its last run has left cannot be removed: "
                     + sentence(error));
      });
}

} // namespace roscell
