#include "actors/cell/state/coordinator_store.hpp"

#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

constexpr std::chrono::seconds store_timeout{5};

} // namespace

void keep_record(coordinator_pointer self, const store_record& record,
                 std::function<void()> kept,
                 std::function<void(const failure&)> not_kept) {
  const auto& st = self->state;
  if (!st.setup.store)
    return kept();
  self->request(st.setup.store, store_timeout, record)
      .then([kept = std::move(kept)](const record_stored&) { kept(); },
            [self, key = record.key,
             not_kept = std::move(not_kept)](const caf::error& err) {
              const auto why = to_failure(err);
              self->state.context.tell("store_failed", key,
                                       {{"reason", why.message}});
              not_kept(why);
            });
}

void record_fact(coordinator_pointer self, const store_record& record) {
  keep_record(
      self, record, [] {}, [](const failure&) {});
}

} // namespace roscell
