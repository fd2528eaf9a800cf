#include "actors/cell/cell_slots.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/session/limits.hpp"
#include "messages/failure.hpp"

#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

using promise_type = caf::typed_response_promise<place_granted>;

/// The cells that do not take a node, and why the last one does not.
struct refused_cells {
  std::set<std::string> uuids;
  std::optional<failure> why;
};

/// The UUID of the cell with the fewest nodes that is not `refused`; empty if
/// none is left.
std::string smallest(const cell_coordinator_state& st,
                     const std::set<std::string>& refused) {
  std::string result;
  int64_t least = 0;
  auto consider = [&](const std::string& uuid, int64_t size) {
    if (refused.count(uuid) == 0 && (result.empty() || size < least)) {
      result = uuid;
      least = size;
    }
  };
  consider(st.setup.self.uuid, static_cast<int64_t>(st.registry.size()));
  st.peers.for_each_session(
      [&](const std::string& uuid, const peer_entry& peer) {
        if (peer.reported)
          consider(uuid, size_of(st, uuid, peer));
      });
  return result;
}

caf::error no_cell_takes(const place_request& request,
                         const refused_cells& refused) {
  return fail(error_code::conflict,
              "no cell takes node '" + request.name + "': "
                  + (refused.why ? refused.why->message : "there is none"),
              "/name", refused.why ? refused.why->hint : "");
}

place_reservation reservation_for(const place_request& request) {
  const std::chrono::milliseconds span{limits::cell::place};
  return {request.name, request.uuid, request.epoch, span.count()};
}

void find_slot(coordinator_pointer self, const place_request& request,
               refused_cells refused, promise_type promise);

void grant_slot_here(coordinator_pointer self, const place_request& request,
                     refused_cells refused, promise_type promise) {
  auto& st = self->state;
  auto kept = reserve_here(self, reservation_for(request));
  if (!kept) {
    refused.uuids.insert(st.setup.self.uuid);
    refused.why = to_failure(kept.error());
    return find_slot(self, request, std::move(refused), std::move(promise));
  }
  st.slots.promise(request.uuid, st.setup.self.uuid, self->clock().now());
  promise.deliver(place_granted{own_address(st.setup)});
}

void on_slot_persisted(coordinator_pointer self, const std::string& uuid,
                       const place_request& request, promise_type promise) {
  auto& st = self->state;
  const auto* holder = st.peers.find(uuid);
  if (!holder) {
    st.slots.forget(request.uuid, uuid);
    promise.deliver(fail(error_code::unreachable, "the cell has just gone"));
    return;
  }
  promise.deliver(place_granted{holder->status.place});
}

void grant_slot_at(coordinator_pointer self, const std::string& uuid,
                   const place_request& request, refused_cells refused,
                   promise_type promise) {
  auto& st = self->state;
  const auto* peer = st.peers.find(uuid);
  st.slots.promise(request.uuid, uuid, self->clock().now());
  self->request(peer->actor, limits::session::peer_answer,
                reservation_for(request))
      .then(
          [=](const place_reserved&) {
            on_slot_persisted(self, uuid, request, promise);
          },
          [=](const caf::error& why) {
            self->state.slots.forget(request.uuid, uuid);
            auto others = refused;
            others.uuids.insert(uuid);
            others.why = to_failure(why);
            find_slot(self, request, std::move(others), promise);
          });
}

void find_slot(coordinator_pointer self, const place_request& request,
               refused_cells refused, promise_type promise) {
  const auto uuid = smallest(self->state, refused.uuids);
  if (uuid.empty())
    promise.deliver(no_cell_takes(request, refused));
  else if (uuid == self->state.setup.self.uuid)
    grant_slot_here(self, request, std::move(refused), std::move(promise));
  else
    grant_slot_at(self, uuid, request, std::move(refused), std::move(promise));
}

/// The cell of the slot that the node has got already, if that is still there.
std::string known_slot(coordinator_pointer self, const std::string& node) {
  auto& st = self->state;
  const auto uuid = st.slots.find(node, self->clock().now());
  const auto* peer = st.peers.find(uuid);
  const bool there = uuid == st.setup.self.uuid || (peer && peer->reported);
  return there ? uuid : std::string{};
}

/// The coordinator with the lowest UUID, if it is not this one.
const peer_entry* slot_arbiter(const cell_coordinator_state& st) {
  const peer_entry* result = nullptr;
  st.peers.for_each_session(
      [&](const std::string& uuid, const peer_entry& peer) {
        if (!result && peer.reported && uuid < st.setup.self.uuid)
          result = &peer;
      });
  return result;
}

void ask_slot_arbiter(coordinator_pointer self, const peer_entry& arbiter,
                      const place_request& request, promise_type promise) {
  self->request(arbiter.actor, limits::membership::place, request)
      .then([promise](place_granted& x) mutable { promise.deliver(x); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
}

void grant_now(coordinator_pointer self, const place_request& request,
               promise_type promise) {
  if (const auto* arbiter = slot_arbiter(self->state))
    return ask_slot_arbiter(self, *arbiter, request, std::move(promise));
  const auto known = known_slot(self, request.uuid);
  if (known.empty())
    find_slot(self, request, {}, std::move(promise));
  else if (known == self->state.setup.self.uuid)
    grant_slot_here(self, request, {}, std::move(promise));
  else
    grant_slot_at(self, known, request, {}, std::move(promise));
}

} // namespace

bool is_slot_arbiter(const cell_coordinator_state& st) {
  return slot_arbiter(st) == nullptr;
}

int64_t size_of(const cell_coordinator_state& st, const std::string& uuid,
                const peer_entry& peer) {
  return peer.status.size
         + st.slots.count_at(uuid, [&](const std::string& node) {
             return peer.members.count(node) > 0;
           });
}

caf::result<place_granted> grant_slot(coordinator_pointer self,
                                      const place_request& request) {
  auto& st = self->state;
  const auto now = self->clock().now();
  auto promise = self->make_response_promise<place_granted>();
  const bool waits =
      st.peers.expects_statuses(now)
      && st.slots.await_sizes([=] { grant_now(self, request, promise); }, now);
  if (waits)
    set_timer(self);
  else
    grant_now(self, request, promise);
  return promise;
}

void grant_awaited_slots(coordinator_pointer self) {
  auto& st = self->state;
  if (st.peers.expects_statuses(self->clock().now()))
    return;
  for (const auto& x : st.slots.take_all_who_await_sizes())
    x.done();
}

caf::expected<place_reserved> reserve_here(coordinator_pointer self,
                                           const place_reservation& request) {
  auto& st = self->state;
  const node_identity who{request.name, request.uuid, request.epoch, ""};
  if (request.name == st.setup.self.name || request.uuid == st.setup.self.uuid)
    return fail(error_code::conflict,
                "'" + request.name + "' is the coordination node of cell '"
                    + st.setup.cell + "'");
  if (auto why = st.registry.refusal(who, now_of(self)))
    return to_error(*why);
  st.registry.reserve(
      who, self->clock().now() + std::chrono::milliseconds{request.hold_ms},
      now_of(self));
  publish(self, {request.uuid});
  set_timer(self);
  return place_reserved{static_cast<int64_t>(st.registry.size())};
}

caf::result<place_reserved> reserve_slot(coordinator_pointer self,
                                         const place_reservation& request) {
  auto kept = reserve_here(self, request);
  if (!kept)
    return std::move(kept.error());
  return *kept;
}

void settle_overdue_slots(coordinator_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (const auto& x : st.slots.take_overdue_who_await_sizes(now))
    x.done();
  st.slots.drop_overdue_slots(now);
  const auto gone = st.registry.drop_overdue(now);
  if (gone.empty())
    return;
  publish(self, {}, gone);
  arm_balance(self);
}

} // namespace roscell
