#include "actors/house/limits.hpp"
#include "actors/membership/membership_steps.hpp"

#include <algorithm>
#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

/// The one that hands out places: the lowest UUID, as every node computes it.
const node_presence* place_giver(const membership_status& st) {
  for (const auto& [uuid, who] : st.coordinators)
    if (st.silent.count(uuid) == 0)
      return &who;
  return nullptr;
}

void on_granted(self_pointer self, const place_granted& reply) {
  auto& st = self->state;
  drop_session(self, "it has been given a place");
  st.silent.clear();
  st.wanted = reply.place.discovery_server;
  st.origin = join_origin::discovered;
  begin_attempt(self);
}

void ask_for_place(self_pointer self, const session_opened& reply) {
  auto& st = self->state;
  take_session(self, reply.session);
  const auto& me = st.config.identity;
  st.frames.call(message_json(place_request{me.name, me.uuid, me.epoch}),
                 self->clock().now() + limits::membership::place,
                 [self, attempt = st.attempt](const caf::expected<json>& body) {
                   if (!is_current(self, attempt, phase::asking))
                     return;
                   auto grant =
                       body ? reply_as<place_granted>(*body) : body.error();
                   if (grant)
                     on_granted(self, *grant);
                   else
                     on_error(self, grant.error());
                 });
  set_timer(self);
}

void open_to(self_pointer self, const node_presence& giver) {
  auto& st = self->state;
  ++st.attempt;
  st.phase = phase::asking;
  st.asked = giver.uuid;
  if (st.standing == node_state::independent)
    st.standing = node_state::joining;
  self->request(st.parts.connector, limits::session::open,
                open_session{giver.address, st.config.identity})
      .then(
          [self, attempt = st.attempt](const session_opened& reply) {
            if (is_current(self, attempt, phase::asking))
              ask_for_place(self, reply);
            else
              self->send(reply.session, close_session{"not wanted any more"});
          },
          [self, attempt = st.attempt](const caf::error& why) {
            if (is_current(self, attempt, phase::asking))
              on_error(self, why);
          });
  set_timer(self);
}

/// Waits a moment, so that others may appear too.
void gather(self_pointer self) {
  auto& st = self->state;
  st.phase = phase::waiting;
  st.deadline = self->clock().now() + limits::membership::gathering;
  set_timer(self);
}

/// The coordinator that an orphan waits for is back, maybe at a new address.
void return_to(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  st.wanted = who.discovery_server;
  if (st.phase != phase::waiting)
    return;
  st.pause.reset();
  begin_attempt(self);
}

} // namespace

void show_presence(self_pointer self) {
  auto& st = self->state;
  const auto& me = st.config.identity;
  const bool orphaned = st.standing == node_state::orphaned;
  node_presence x;
  x.role = orphaned ? "orphaned" : "independent";
  x.name = me.name;
  x.uuid = me.uuid;
  x.epoch = me.epoch;
  x.cell = st.cell;
  x.address = me.address;
  if (st.shown == x)
    return;
  st.shown = x;
  self->send(st.parts.discovery, announce_presence{std::move(x)});
}

void withdraw_presence_now(self_pointer self) {
  auto& st = self->state;
  if (!std::exchange(st.shown, std::nullopt))
    return;
  st.coordinators.clear();
  st.silent.clear();
  self->send(st.parts.discovery, withdraw_presence{});
}

void on_presence_seen(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  if (who.role != "coordinator" || !st.shown)
    return;
  const auto [known, is_new] = st.coordinators.insert_or_assign(who.uuid, who);
  st.silent.erase(known->first);
  if (st.standing == node_state::orphaned && who.cell == st.cell)
    return_to(self, who);
  else if (st.seeking && st.wanted.empty()
           && (st.phase == phase::resting || st.phase == phase::waiting))
    gather(self);
}

void on_presence_gone(self_pointer self, const node_presence& who) {
  self->state.coordinators.erase(who.uuid);
}

void seek_place(self_pointer self) {
  auto& st = self->state;
  show_presence(self);
  if (!st.coordinators.empty() && !place_giver(st))
    st.silent.clear();
  if (const auto* giver = place_giver(st); giver && st.seeking)
    return open_to(self, *giver);
  st.phase = phase::resting;
  if (st.standing == node_state::joining)
    st.standing = node_state::independent;
}

void forget_place(self_pointer self) {
  auto& st = self->state;
  if (!st.asked.empty() && st.phase == phase::asking)
    st.silent.insert(st.asked);
  st.asked.clear();
  // A node that has been in the cell goes on looking for it.
  if (st.seeking && st.standing != node_state::orphaned)
    st.wanted.clear();
}

} // namespace roscell::membership_steps
