#include "actors/cell/state/transfer_end.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

namespace roscell {

namespace {

/// The failure as whoever asked hears it.
failure with_losses(failure why, const cell_transfer& x) {
  if (x.terminated.empty())
    return why;
  why.message += "; terminated for it:";
  for (const auto& task : x.terminated)
    why.message += " '" + task + "'";
  return why;
}

void publish_transfer_end(coordinator_pointer self, const transfer_row& row) {
  json data{{"transfer", row.transfer},
            {"from", row.from},
            {"to", row.to},
            {"state", row.state}};
  if (!row.reason.empty())
    data["reason"] = row.reason;
  self->state.context.publish_event(events::transfer_ended, row.node, data);
}

} // namespace

void end_transfer(coordinator_pointer self, const std::string& id,
                  transfer_state state, const std::string& reason,
                  const completion& how) {
  auto& table = self->state.transfers;
  const auto ended = table.end(id, state, reason, now_of(self).unix_ms);
  if (!ended)
    return;
  persist_record(self, record_of(ended->row));
  for (const auto& old : table.forget_oldest())
    persist_record(self, {"transfers", old, ""});
  publish_transfer_end(self, ended->row);
  const auto reported =
      how ? completion{} : completion{with_losses(how.error(), *ended)};
  for (const auto& done : ended->waiting)
    done(*ended, reported);
}

void call_off_transfer(coordinator_pointer self, const std::string& id,
                       const failure& why) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  auto* entry = st.registry.find_uuid(x->row.uuid);
  if (entry && entry->row.state == row_state::departing) {
    if (entry->member)
      st.registry.stay(*entry, now_of(self));
    else
      st.registry.deactivate(*entry, row_state::lost,
                             "it missed its heartbeats while it was to leave",
                             now_of(self));
    publish(self, {entry->row.identity.uuid});
    arm_balance(self);
  }
  end_transfer(self, id, transfer_state::returned, why.message, why);
}

} // namespace roscell
