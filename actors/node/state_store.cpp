#include "actors/node/state_store.hpp"

#include "messages/failure.hpp"

#include <caf/result.hpp>

#include <utility>

namespace roscell {

namespace {

using self_pointer = state_store_actor::stateful_pointer<state_store_state>;

caf::result<record_stored> store(self_pointer self, const store_record& x) {
  auto& st = self->state;
  const auto error = x.value.empty()
                         ? st.database->remove(x.table, x.key)
                         : st.database->put(x.table, x.key, x.value);
  ++(error ? st.refused : st.written);
  if (error)
    return fail(error->code, error->message, {}, error->hint);
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
      [self](const store_record& x) { return store(self, x); },
  };
}

} // namespace roscell
