#include "actors/node/node_history.hpp"

#include "actors/core/alarm.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/core/shifted_times.hpp"
#include "actors/edge/process/instance_log.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <chrono>
#include <optional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

using node_history_self =
    node_history_actor::stateful_pointer<node_history_state>;

caf::result<events_written> write_batch(node_history_self self,
                                        event_batch batch) {
  auto& st = self->state;
  const auto count = batch.events.size();
  const auto shift = to_wall_clock();
  for (auto& x : batch.events)
    x.time_unix_ms = shift(x.time_unix_ms);
  auto done = st.folder->write(batch);
  if (auto* why = std::get_if<edge_error>(&done)) {
    st.refused += count;
    return to_caf(*why);
  }
  st.written += count;
  return std::get<events_written>(done);
}

/// It looks at all that is kept, which tasks that come and go without end would
/// have it do each time.
void on_log_kept(node_history_self self) {
  using namespace std::chrono;
  constexpr seconds pause{1};
  auto& st = self->state;
  const auto now = self->clock().now();
  if (now - st.held_at >= pause) {
    st.holds_soon = false;
    st.held_at = now;
    return st.folder->hold_bound();
  }
  if (!std::exchange(st.holds_soon, true))
    send_lasting_actor_later(node_history_actor{self},
                             pause - (now - st.held_at), log_kept{});
}

} // namespace

node_history_actor::behavior_type
node_history(node_history_self self, std::shared_ptr<history_folder> folder) {
  self->state.folder = std::move(folder);
  return {
      [self](const state_query&) {
        return state_of({{"events_written", self->state.written},
                         {"events_refused", self->state.refused}});
      },
      [self](const event_batch& x) { return write_batch(self, x); },
      [self](const past_events_query& x) {
        return kept_events{self->state.folder->read(x)};
      },
      [self](const log_kept&) { on_log_kept(self); },
      [self](const log_query& x) {
        return read_kept_log(*self->state.folder, x);
      },
      [self](const kept_logs_query& x) {
        return list_kept_logs(*self->state.folder, x);
      },
  };
}

caf::result<log_excerpt> read_kept_log(const history_folder& history,
                                       const log_query& query) {
  const auto log = history.with_logs(
      [&](const auto& logs) { return logs.newest_of(query.instance); });
  if (!log)
    return fail(error_code::unknown_task,
                "no log of an instance '" + query.instance + "' is kept",
                "/instance",
                "`roscell instances` lists those that are there, `roscell logs "
                "--previous` the logs of those that are gone");
  const auto lines =
      query.tail_lines > 0 ? query.tail_lines : instance_log::default_lines;
  auto part = query.offset < 0 ? log->read_tail(lines, query.times)
                               : log->read_from(query.offset, query.times);
  return log_excerpt{
      query.instance, std::move(part.text),          part.next_offset,
      part.ended,     std::move(part.times_unix_ms), std::move(part.bytes)};
}

kept_logs list_kept_logs(const history_folder& history,
                         const kept_logs_query& query) {
  return history.with_logs([&](const auto& logs) { return logs.list(query); });
}

} // namespace roscell
