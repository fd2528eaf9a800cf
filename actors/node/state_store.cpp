#include "actors/node/state_store.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/core/shifted_times.hpp"
#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace roscell {

namespace {

using state_store_self = state_store_actor::stateful_pointer<state_store_state>;
using changes = std::vector<sqlite_store::change>;

sqlite_store::change change_of(const std::string& table, const std::string& key,
                               const std::string& value) {
  if (value.empty())
    return {table, key, std::nullopt};
  return {table, key, with_times_shifted(value, to_wall_clock())};
}

changes changes_of(const std::vector<store_record>& records) {
  changes result;
  for (const auto& x : records)
    result.push_back(change_of(x.table, x.key, x.value));
  return result;
}

/// What waits is older than all that comes, so it goes first.
changes with_waiting(const state_store_state& st, const changes& fresh) {
  changes result;
  for (const auto& [name, value] : st.waiting)
    result.push_back(change_of(name.first, name.second, value));
  result.insert(result.end(), fresh.begin(), fresh.end());
  return result;
}

void on_caught_up(state_store_self self) {
  auto& st = self->state;
  if (st.waiting.empty())
    return;
  st.context.publish_event(events::store_caught_up, "",
                           {{"records", st.waiting.size()}});
  st.written += st.waiting.size();
  st.waiting.clear();
  st.pause.reset();
}

/// Writes `fresh` and what waits; where there is no room for both, at least
/// `fresh`.
std::optional<edge_error> write(state_store_self self, const changes& fresh) {
  auto& st = self->state;
  auto error = st.database->write(with_waiting(st, fresh));
  if (!error) {
    on_caught_up(self);
    return std::nullopt;
  }
  if (st.waiting.empty() || fresh.empty())
    return error;
  error = st.database->write(fresh);
  if (!error)
    for (const auto& x : fresh)
      st.waiting.erase({x.table, x.key});
  return error;
}

bool may_wait(const state_store_state& st,
              const std::vector<store_record>& records) {
  return st.waiting.size() + records.size() <= limits::store::waiting
         && std::all_of(records.begin(), records.end(),
                        [](const auto& x) { return x.may_wait; });
}

void keep_waiting(state_store_self self,
                  const std::vector<store_record>& records,
                  const edge_error& why) {
  auto& st = self->state;
  if (st.waiting.empty()) {
    st.context.publish_event(
        events::store_failed, "",
        {{"message", why.message},
         {"hint", why.hint},
         {"until_then", "what must not be lost is in memory"}});
    st.timer.set(self, self->clock().now() + st.pause.next());
  }
  for (const auto& x : records)
    st.waiting[{x.table, x.key}] = x.value;
}

double size_of(const std::vector<store_record>& records) {
  size_t result = 0;
  for (const auto& x : records)
    result += x.table.size() + x.key.size() + x.value.size();
  return static_cast<double>(result);
}

caf::result<record_stored> store(state_store_self self,
                                 const std::vector<store_record>& records) {
  auto& st = self->state;
  const auto error = write(self, changes_of(records));
  if (!error) {
    st.written += records.size();
    st.context.count(metric::store_written_bytes, {}, size_of(records));
    return record_stored{};
  }
  if (may_wait(st, records)) {
    keep_waiting(self, records, *error);
    return record_stored{};
  }
  st.refused += records.size();
  return to_caf(*error);
}

/// The kernel tells nobody that there is room again, so it is tried.
void on_alarm(state_store_self self) {
  auto& st = self->state;
  if (!st.waiting.empty() && write(self, {}))
    st.timer.set(self, self->clock().now() + st.pause.next());
}

} // namespace

state_store_actor::behavior_type
state_store(state_store_self self, const actor_context& context,
            std::shared_ptr<sqlite_store> database) {
  self->state.context = context;
  self->state.database = std::move(database);
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"records_written", st.written},
                         {"records_refused", st.refused},
                         {"records_waiting", st.waiting.size()}});
      },
      [self](const store_record& x) { return store(self, {x}); },
      [self](const store_records& x) { return store(self, x.records); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
