#include "actors/node/state_store.hpp"

#include "actors/house/edge_failure.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <utility>
#include <vector>

namespace roscell {

namespace {

using self_pointer = state_store_actor::stateful_pointer<state_store_state>;

sqlite_store::change change_of(const store_record& x) {
  if (x.value.empty())
    return {x.table, x.key, std::nullopt};
  return {x.table, x.key, x.value};
}

caf::result<record_stored> store(self_pointer self,
                                 const std::vector<store_record>& records) {
  std::vector<sqlite_store::change> changes;
  for (const auto& x : records)
    changes.push_back(change_of(x));
  auto& st = self->state;
  const auto error = st.database->write(changes);
  (error ? st.refused : st.written) += records.size();
  if (error)
    return to_caf(*error);
  return record_stored{};
}

} // namespace

state_store_actor::behavior_type
state_store(self_pointer self, std::shared_ptr<sqlite_store> database) {
  self->state.database = std::move(database);
  return {
      [self](const state_query&) {
        return state_of({{"written", self->state.written},
                         {"refused", self->state.refused}});
      },
      [self](const store_record& x) { return store(self, {x}); },
      [self](const store_records& x) { return store(self, x.records); },
  };
}

} // namespace roscell
