#include "actors/cell/cell_places.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/house/limits.hpp"
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
        if (peer.told)
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

void find_place(coordinator_pointer self, const place_request& request,
                refused_cells refused, promise_type promise);

void place_here(coordinator_pointer self, const place_request& request,
                refused_cells refused, promise_type promise) {
  auto& st = self->state;
  auto kept = reserve_here(self, reservation_for(request));
  if (!kept) {
    refused.uuids.insert(st.setup.self.uuid);
    refused.why = to_failure(kept.error());
    return find_place(self, request, std::move(refused), std::move(promise));
  }
  st.places.promise(request.uuid, st.setup.self.uuid, self->clock().now());
  promise.deliver(place_granted{own_address(st.setup)});
}

void on_place_kept(coordinator_pointer self, const std::string& uuid,
                   const place_request& request, promise_type promise) {
  auto& st = self->state;
  const auto* holder = st.peers.find(uuid);
  if (!holder) {
    st.places.forget(request.uuid, uuid);
    promise.deliver(fail(error_code::unreachable, "the cell has just gone"));
    return;
  }
  promise.deliver(place_granted{holder->standing.place});
}

void place_at(coordinator_pointer self, const std::string& uuid,
              const place_request& request, refused_cells refused,
              promise_type promise) {
  auto& st = self->state;
  const auto* peer = st.peers.find(uuid);
  st.places.promise(request.uuid, uuid, self->clock().now());
  self->request(peer->actor, limits::session::peer_answer,
                reservation_for(request))
      .then(
          [=](const place_reserved&) {
            on_place_kept(self, uuid, request, promise);
          },
          [=](const caf::error& why) {
            self->state.places.forget(request.uuid, uuid);
            auto others = refused;
            others.uuids.insert(uuid);
            others.why = to_failure(why);
            find_place(self, request, std::move(others), promise);
          });
}

void find_place(coordinator_pointer self, const place_request& request,
                refused_cells refused, promise_type promise) {
  const auto uuid = smallest(self->state, refused.uuids);
  if (uuid.empty())
    promise.deliver(no_cell_takes(request, refused));
  else if (uuid == self->state.setup.self.uuid)
    place_here(self, request, std::move(refused), std::move(promise));
  else
    place_at(self, uuid, request, std::move(refused), std::move(promise));
}

/// The place that the node has been given already, if its cell is still there.
std::string known_place(coordinator_pointer self, const std::string& node) {
  auto& st = self->state;
  const auto uuid = st.places.find(node, self->clock().now());
  const auto* peer = st.peers.find(uuid);
  const bool there = uuid == st.setup.self.uuid || (peer && peer->told);
  return there ? uuid : std::string{};
}

/// The coordinator with the lowest UUID, if it is not this one.
const peer_entry* place_giver(const cell_coordinator_state& st) {
  const peer_entry* result = nullptr;
  st.peers.for_each_session(
      [&](const std::string& uuid, const peer_entry& peer) {
        if (!result && peer.told && uuid < st.setup.self.uuid)
          result = &peer;
      });
  return result;
}

void ask_place_giver(coordinator_pointer self, const peer_entry& giver,
                     const place_request& request, promise_type promise) {
  self->request(giver.actor, limits::membership::place, request)
      .then([promise](place_granted& x) mutable { promise.deliver(x); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
}

void grant_now(coordinator_pointer self, const place_request& request,
               promise_type promise) {
  if (const auto* giver = place_giver(self->state))
    return ask_place_giver(self, *giver, request, std::move(promise));
  const auto known = known_place(self, request.uuid);
  if (known.empty())
    find_place(self, request, {}, std::move(promise));
  else if (known == self->state.setup.self.uuid)
    place_here(self, request, {}, std::move(promise));
  else
    place_at(self, known, request, {}, std::move(promise));
}

} // namespace

bool gives_places(const cell_coordinator_state& st) {
  return place_giver(st) == nullptr;
}

int64_t size_of(const cell_coordinator_state& st, const std::string& uuid,
                const peer_entry& peer) {
  return peer.standing.size
         + st.places.count_at(uuid, [&](const std::string& node) {
             return peer.members.count(node) > 0;
           });
}

caf::result<place_granted> grant_place(coordinator_pointer self,
                                       const place_request& request) {
  auto& st = self->state;
  const auto now = self->clock().now();
  auto promise = self->make_response_promise<place_granted>();
  const bool waits =
      st.peers.expects_standings(now)
      && st.places.await_sizes([=] { grant_now(self, request, promise); }, now);
  if (waits)
    set_timer(self);
  else
    grant_now(self, request, promise);
  return promise;
}

void grant_awaited_places(coordinator_pointer self) {
  auto& st = self->state;
  if (st.peers.expects_standings(self->clock().now()))
    return;
  for (const auto& x : st.places.take_all_who_await_sizes())
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

caf::result<place_reserved> reserve_place(coordinator_pointer self,
                                          const place_reservation& request) {
  auto kept = reserve_here(self, request);
  if (!kept)
    return std::move(kept.error());
  return *kept;
}

void settle_overdue_places(coordinator_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (const auto& x : st.places.take_overdue_who_await_sizes(now))
    x.done();
  st.places.drop_overdue_places(now);
  const auto gone = st.registry.drop_overdue(now);
  if (gone.empty())
    return;
  publish(self, {}, gone);
  arm_balance(self);
}

} // namespace roscell
