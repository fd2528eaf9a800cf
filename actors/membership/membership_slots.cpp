#include "actors/core/clocks.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/membership/limits.hpp"
#include "actors/membership/membership_steps.hpp"
#include "actors/session/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

void on_granted(self_pointer self, const place_granted& reply) {
  auto& st = self->state;
  drop_session(self, "it has been granted a slot");
  st.coordinators.forgive();
  st.wanted = reply.place.discovery_server;
  st.origin = join_origin::discovered;
  begin_attempt(self);
}

void ask_for_slot(self_pointer self, const session_opened& reply) {
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

void open_to(self_pointer self, const node_presence& arbiter) {
  auto& st = self->state;
  ++st.attempt;
  st.report.begin({}, unix_now_ms());
  st.phase = phase::asking;
  st.asked = arbiter.uuid;
  if (st.state == node_state::independent)
    st.state = node_state::joining;
  self->request(st.parts.connector, limits::session::open,
                open_session{arbiter.address, st.config.identity,
                             node_role::primary, arbiter.uuid})
      .then(
          [self, attempt = st.attempt](const session_opened& reply) {
            if (is_current(self, attempt, phase::asking))
              ask_for_slot(self, reply);
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

/// Whether that is the cell that the node was in. Several may have its name.
bool is_own_cell(const membership_status& st, const node_presence& who) {
  const bool known = !st.cell_uuid.empty() && !who.cell_uuid.empty();
  return known ? who.cell_uuid == st.cell_uuid : who.cell == st.cell;
}

/// Where the node was in its cell, as a handshake has proven; empty: unknown.
std::string former_place(const membership_status& st) {
  return st.stored ? st.stored->discovery_server : std::string{};
}

/// The coordinator that an orphan waits for is back, maybe at a new address.
/// Everybody may say so: what leads elsewhere waits while another such place is
/// tried, and until the former one has been tried after it.
void return_to(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  const auto former = former_place(st);
  const bool leads_away = who.discovery_server != former && !former.empty();
  if (leads_away)
    st.announced_place = who.discovery_server;
  const bool elsewhere = st.wanted != who.discovery_server;
  const bool tries_announced =
      st.phase == phase::searching && st.wanted != former;
  // Each announcement cuts short one pause, or one search where it is not any
  // more. Else a node that is thrown out again and again would come back as
  // often.
  const bool idle =
      st.phase == phase::waiting || (st.phase == phase::searching && elsewhere);
  if (!idle || st.hurried == who
      || (leads_away && (st.owes_former || tries_announced)))
    return;
  st.hurried = who;
  st.wanted = who.discovery_server;
  st.pause.reset();
  begin_attempt(self);
}

/// Whether that is a later life of the coordinator that says nothing any more.
/// Only a handshake proves it, so who is heard is not left for it.
bool has_begun_anew(const membership_status& st, const node_presence& who) {
  return st.phase == phase::joined && is_own_cell(st, who)
         && who.name == st.coordinator && who.incarnation > st.incarnation;
}

void leave_for(self_pointer self, const node_presence& who) {
  self->state.wanted = who.discovery_server;
  on_session_lost(self, "the coordinator has started again at " + who.address);
}

} // namespace

void seek_coordinator(self_pointer self) {
  auto& st = self->state;
  // Heartbeats that are lost one by one are no reason to look around.
  constexpr auto doubt =
      limits::lease::heartbeat_period + std::chrono::seconds{1};
  if (st.phase != phase::joined || st.shown
      || self->clock().now() - st.life.last_heard() < doubt)
    return;
  node_presence x;
  x.role = "surveyor";
  st.shown = x;
  self->send(st.parts.discovery, announce_presence{std::move(x)});
}

void show_presence(self_pointer self) {
  auto& st = self->state;
  const auto& me = st.config.identity;
  const bool orphaned = st.state == node_state::orphaned;
  node_presence x;
  x.role = orphaned ? "orphaned" : "independent";
  x.name = me.name;
  x.uuid = me.uuid;
  x.epoch = me.epoch;
  x.cell = st.cell;
  x.cell_uuid = st.cell_uuid;
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
  self->send(st.parts.discovery, withdraw_presence{});
}

void on_presence_seen(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  if (who.role != "coordinator" || !st.shown)
    return;
  if (has_begun_anew(st, who))
    return leave_for(self, who);
  const bool news = st.coordinators.see(who);
  if (st.state == node_state::orphaned && is_own_cell(st, who))
    return_to(self, who);
  else if (news && st.seeking && st.wanted.empty()
           && (st.phase == phase::resting || st.phase == phase::waiting))
    gather(self);
}

void on_presence_gone(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  if (who.role != "coordinator")
    return;
  st.coordinators.vanish(who.uuid);
  if (st.announced_place == who.discovery_server)
    st.announced_place.clear();
}

bool turn_elsewhere(self_pointer self, bool refused) {
  auto& st = self->state;
  const auto former = former_place(st);
  if (st.state != node_state::orphaned || former.empty())
    return false;
  st.owes_former = st.wanted != former;
  if (st.owes_former && refused && st.announced_place == st.wanted)
    st.announced_place.clear();
  const auto& next = st.owes_former || st.announced_place.empty()
                         ? former
                         : st.announced_place;
  const bool changed = next != st.wanted;
  st.wanted = std::string{next};
  return changed;
}

void seek_slot(self_pointer self) {
  auto& st = self->state;
  show_presence(self);
  if (!st.coordinators.slot_arbiter())
    st.coordinators.forgive();
  const auto* arbiter = st.coordinators.slot_arbiter();
  if (arbiter && st.seeking)
    return open_to(self, *arbiter);
  st.phase = phase::resting;
  if (st.state == node_state::joining)
    st.state = node_state::independent;
  if (!st.seeking)
    return;
  st.report.begin({}, unix_now_ms());
  st.look_due = self->clock().now() + limits::membership::silence;
  set_timer(self);
}

void forget_slot(self_pointer self) {
  auto& st = self->state;
  if (!st.asked.empty() && st.phase == phase::asking)
    st.coordinators.mark_unresponsive(st.asked);
  st.asked.clear();
  // A node that has been in the cell goes on looking for it.
  if (st.seeking && st.state != node_state::orphaned)
    st.wanted.clear();
}

} // namespace roscell::membership_steps
