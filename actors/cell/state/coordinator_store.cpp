#include "actors/cell/state/coordinator_store.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/member_presence.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
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

void publish(coordinator_pointer self,
             const std::vector<std::string>& changed_uuids,
             const std::vector<std::string>& gone_uuids) {
  auto& st = self->state;
  cell_changed change;
  change.size = static_cast<int64_t>(st.registry.size());
  change.gone = gone_uuids;
  for (const auto& uuid : changed_uuids)
    if (const auto* entry = st.registry.find_uuid(uuid))
      change.changed.push_back(claim_of(entry->row));
  st.peers.for_each_session([&](const std::string&, const peer_entry& peer) {
    self->send(peer.actor, change);
  });
  look_at_sets(self);
}

void drop_row(coordinator_pointer self, const std::string& uuid) {
  auto& st = self->state;
  const auto* entry = st.registry.find_uuid(uuid);
  if (!entry)
    return;
  if (entry->row.state != row_state::reserved)
    persist_record(self, {"members", uuid, ""});
  st.deployments.forget_node(entry->row.identity.name);
  follow_member_server(self, *entry, server_contact::gone);
  st.registry.erase(uuid);
  publish(self, {}, {uuid});
}

namespace {

/// A reason may quote a log.
std::string bounded_text(json data) {
  for (auto& [name, value] : data.items())
    if (value.is_string()
        && value.get_ref<const std::string&>().size()
               > limits::task::event_text_bytes)
      value =
          value.get<std::string>().substr(0, limits::task::event_text_bytes);
  return data.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Tells it, and takes it up into the history.
void add_event(coordinator_pointer self, const event_kind& what,
               const std::string& task, const std::string& subject,
               const json& data) {
  auto& st = self->state;
  st.context.publish_event(what, subject, data);
  auto added = st.history.add(task, {0, unix_now_ms(), std::string{what.name},
                                     subject, bounded_text(data)});
  const auto& recorded = added.record.recorded;
  st.events.push_back({"history", history_key(task, recorded.sequence),
                       json(added.record).dump(), true});
  for (auto& key : added.dropped)
    st.events.push_back({"history", std::move(key), "", true});
}

void write_events(coordinator_pointer self) {
  auto& st = self->state;
  st.events_due = std::chrono::steady_clock::time_point::max();
  keep_records(
      self, std::exchange(st.events, {}), [] {}, [](const failure&) {});
}

} // namespace

void publish_task_event(coordinator_pointer self, const event_kind& what,
                        const std::string& task, const std::string& subject,
                        const json& data) {
  add_event(self, what, task, subject, data);
  write_events(self);
}

void publish_repeated_event(coordinator_pointer self, const event_kind& what,
                            const std::string& task, const std::string& subject,
                            const json& data) {
  constexpr std::chrono::seconds span{2};
  constexpr size_t most = 128;
  add_event(self, what, task, subject, data);
  auto& st = self->state;
  if (st.events.size() >= most)
    return write_events(self);
  st.events_due = std::min(st.events_due, self->clock().now() + span);
  set_timer(self);
}

void write_due_events(coordinator_pointer self) {
  if (self->clock().now() >= self->state.events_due)
    write_events(self);
}

caf::result<task_history> report_history(coordinator_pointer self,
                                         const task_history_query& query) {
  if (auto known = self->state.history.find(query.task))
    return std::move(*known);
  return fail(error_code::unknown_task,
              "nothing is known of a task '" + query.task + "'", "/task",
              "`roscell tasks` lists those that are there");
}

} // namespace roscell
