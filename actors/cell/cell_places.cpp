#include "actors/cell/cell_places.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/house/limits.hpp"
#include "messages/failure.hpp"

#include <set>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;
using promise_type = caf::typed_response_promise<place_granted>;

/// The UUID of the cell with the fewest nodes that is not `full`; empty if none
/// is left.
std::string smallest(const cell_coordinator_state& st,
                     const std::set<std::string>& full) {
  std::string result;
  int64_t least = 0;
  auto consider = [&](const std::string& uuid, int64_t size) {
    if (full.count(uuid) == 0 && (result.empty() || size < least)) {
      result = uuid;
      least = size;
    }
  };
  consider(st.setup.self.uuid, static_cast<int64_t>(st.registry.size()));
  st.peers.for_each_session(
      [&](const std::string& uuid, const peer_entry& peer) {
        if (peer.told)
          consider(uuid, peer.size());
      });
  return result;
}

void remember(self_pointer self, const place_request& request,
              const std::string& coordinator) {
  self->state.places[request.uuid] = {coordinator, self->clock().now()
                                                       + limits::cell::place};
  set_timer(self);
}

void find_place(self_pointer self, const place_request& request,
                std::set<std::string> full, promise_type promise);

void place_here(self_pointer self, const place_request& request,
                std::set<std::string> full, promise_type promise) {
  auto& st = self->state;
  place_reservation wish{
      request.name, request.uuid, request.epoch,
      std::chrono::milliseconds{limits::cell::place}.count()};
  auto kept = reserve_here(self, wish);
  if (!kept) {
    full.insert(st.setup.self.uuid);
    return find_place(self, request, std::move(full), std::move(promise));
  }
  remember(self, request, st.setup.self.uuid);
  promise.deliver(place_granted{own_address(st.setup)});
}

void place_at(self_pointer self, const std::string& uuid,
              const place_request& request, std::set<std::string> full,
              promise_type promise) {
  auto& peer = *self->state.peers.find(uuid);
  peer.promised.insert(request.uuid);
  place_reservation wish{
      request.name, request.uuid, request.epoch,
      std::chrono::milliseconds{limits::cell::place}.count()};
  self->request(peer.actor, limits::session::peer_answer, wish)
      .then(
          [self, uuid, request, promise](const place_reserved&) mutable {
            auto& st = self->state;
            auto* holder = st.peers.find(uuid);
            if (!holder) {
              promise.deliver(
                  fail(error_code::unreachable, "the cell has just gone"));
              return;
            }
            holder->forget_promise(request.uuid);
            remember(self, request, uuid);
            promise.deliver(place_granted{holder->standing.place});
          },
          [self, uuid, request, full, promise](const caf::error&) mutable {
            if (auto* holder = self->state.peers.find(uuid))
              holder->forget_promise(request.uuid);
            full.insert(uuid);
            find_place(self, request, std::move(full), std::move(promise));
          });
}

void find_place(self_pointer self, const place_request& request,
                std::set<std::string> full, promise_type promise) {
  const auto uuid = smallest(self->state, full);
  if (uuid.empty())
    promise.deliver(fail(error_code::conflict,
                         "no cell takes node '" + request.name
                             + "': its name belongs to another node",
                         "/name", "give the node another --name"));
  else if (uuid == self->state.setup.self.uuid)
    place_here(self, request, std::move(full), std::move(promise));
  else
    place_at(self, uuid, request, std::move(full), std::move(promise));
}

/// The place that the node has been given already, if its cell is still there.
std::string known_place(self_pointer self, const std::string& node) {
  auto& st = self->state;
  const auto i = st.places.find(node);
  if (i == st.places.end() || i->second.until <= self->clock().now())
    return {};
  const auto& uuid = i->second.coordinator;
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

} // namespace

bool gives_places(self_pointer self) {
  return place_giver(self->state) == nullptr;
}

caf::result<place_granted> grant_place(self_pointer self,
                                       const place_request& request) {
  auto promise = self->make_response_promise<place_granted>();
  if (const auto* giver = place_giver(self->state)) {
    self->request(giver->actor, limits::membership::place, request)
        .then([promise](place_granted& x) mutable { promise.deliver(x); },
              [promise](caf::error& why) mutable {
                promise.deliver(std::move(why));
              });
    return promise;
  }
  const auto known = known_place(self, request.uuid);
  if (known.empty())
    find_place(self, request, {}, promise);
  else if (known == self->state.setup.self.uuid)
    place_here(self, request, {}, promise);
  else
    place_at(self, known, request, {}, promise);
  return promise;
}

caf::expected<place_reserved> reserve_here(self_pointer self,
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

caf::result<place_reserved> reserve_place(self_pointer self,
                                          const place_reservation& request) {
  auto kept = reserve_here(self, request);
  if (!kept)
    return std::move(kept.error());
  return *kept;
}

void drop_overdue_places(self_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (auto i = st.places.begin(); i != st.places.end();)
    i = i->second.until <= now ? st.places.erase(i) : std::next(i);
  const auto gone = st.registry.drop_overdue(now);
  if (gone.empty())
    return;
  publish(self, {}, gone);
  arm_balance(self);
}

} // namespace roscell
