#include "actors/cell/state/coordinator_store.hpp"

#include "actors/house/limits.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

void keep_records(coordinator_pointer self, std::vector<store_record> records,
                  std::function<void()> kept,
                  std::function<void(const failure&)> not_kept) {
  const auto& st = self->state;
  if (!st.setup.store || records.empty())
    return kept();
  const auto subject = records.front().key;
  self->request(st.setup.store, limits::store::write,
                store_records{std::move(records)})
      .then([kept = std::move(kept)](const record_stored&) { kept(); },
            [self, subject,
             not_kept = std::move(not_kept)](const caf::error& err) {
              const auto why = to_failure(err);
              self->state.context.tell("store_failed", subject,
                                       {{"reason", why.message}});
              not_kept(why);
            });
}

void forget_refused(coordinator_pointer self, std::string table,
                    std::string key) {
  record_fact(self, {std::move(table), std::move(key), ""});
}

void record_fact(coordinator_pointer self, store_record record) {
  record.may_wait = true;
  keep_records(
      self, {std::move(record)}, [] {}, [](const failure&) {});
}

} // namespace roscell
