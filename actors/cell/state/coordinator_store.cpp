#include "actors/cell/state/coordinator_store.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <utility>

namespace roscell {

namespace {

/// There is room, also for what has found none before.
void hurry_waiting_changes(coordinator_pointer self) {
  constexpr auto none = std::chrono::steady_clock::time_point::max();
  bool is_one_waiting = false;
  for (auto& [task, line] : self->state.pending.lines)
    if (line.retry != none) {
      line.retry = self->clock().now();
      is_one_waiting = true;
    }
  if (is_one_waiting)
    set_timer(self);
}

} // namespace

void keep_records(coordinator_pointer self, std::vector<store_record> records,
                  std::function<void()> kept,
                  std::function<void(const failure&)> not_persisted) {
  const auto& st = self->state;
  if (!st.setup.store || records.empty())
    return kept();
  const auto subject = records.front().key;
  self->request(st.setup.store, limits::store::write,
                store_records{std::move(records)})
      .then(
          [self, kept = std::move(kept)](const record_stored&) {
            kept();
            hurry_waiting_changes(self);
          },
          [self, subject,
           not_persisted = std::move(not_persisted)](const caf::error& err) {
            const auto why = to_failure(err);
            self->state.context.publish_event(events::store_failed, subject,
                                              {{"reason", why.message}});
            not_persisted(why);
          });
}

void forget_refused(coordinator_pointer self, std::string table,
                    std::string key) {
  persist_record(self, {std::move(table), std::move(key), ""});
}

void persist_record(coordinator_pointer self, store_record record) {
  record.may_wait = true;
  keep_records(
      self, {std::move(record)}, [] {}, [](const failure&) {});
}

} // namespace roscell
