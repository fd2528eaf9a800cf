#include "actors/cell/state/transfer_end.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"

#include <utility>

namespace roscell {

namespace {

void forget_oldest(cell_coordinator_state& st) {
  while (st.transfers.size() > limits::transfer::ended) {
    auto oldest = st.transfers.end();
    for (auto i = st.transfers.begin(); i != st.transfers.end(); ++i)
      if (!is_open(i->second.row.state)
          && (oldest == st.transfers.end()
              || i->second.row.since_unix_ms
                     < oldest->second.row.since_unix_ms))
        oldest = i;
    if (oldest == st.transfers.end())
      return;
    st.transfers.erase(oldest);
  }
}

} // namespace

bool is_open(transfer_state x) {
  return x == transfer_state::preparing || x == transfer_state::switching
         || x == transfer_state::unresolved;
}

void enter_state(cell_transfer& x, transfer_state state, std::string reason) {
  x.row.state = state;
  x.row.reason = std::move(reason);
  x.row.since_unix_ms = unix_now_ms();
}

void store_transfer(coordinator_pointer self, const transfer_row& row) {
  if (is_open(row.state))
    record_fact(self, {"transfers", row.transfer, json(row).dump()});
  else
    record_fact(self, {"transfers", row.transfer, ""});
}

void tell_waiting(cell_transfer& x, const failure* why) {
  for (const auto& done : std::exchange(x.waiting, {}))
    done(x, why);
}

void end_transfer(coordinator_pointer self, cell_transfer& x,
                  transfer_state state, const std::string& reason,
                  const failure* why) {
  auto& st = self->state;
  enter_state(x, state, reason);
  x.deadline = std::chrono::steady_clock::time_point::max();
  store_transfer(self, x.row);
  json data{{"transfer", x.row.transfer},
            {"from", x.row.from},
            {"to", x.row.to},
            {"state", x.row.state}};
  if (!reason.empty())
    data["reason"] = reason;
  st.context.tell("transfer_ended", x.row.node, data);
  tell_waiting(x, why);
  forget_oldest(st);
}

} // namespace roscell
