#include "actors/cell/cell_members.hpp"

#include "actors/cell/cell_peers.hpp"
#include "actors/cell/state/arrivals.hpp"
#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/tasks/cell_instances.hpp"
#include "actors/house/limits.hpp"
#include "actors/session/member.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;

/// A node that does not say in this time what it has is not counted on.
constexpr std::chrono::seconds resource_timeout{3};

void stop_searches_on(const cell_coordinator_state& st,
                      const std::string& node) {
  if (st.setup.searches)
    st.setup.searches->node_left(node);
}

/// Nobody is asked twice whether the same row has changed on disk.
void store_member(self_pointer self, const registry_entry& entry) {
  record_fact(self,
              {"members", entry.row.identity.uuid,
               json(member_record{entry.row.identity, entry.origin}).dump()});
}

/// What a node has announced before it registered is out of date. What it has
/// announced since is not: then this registration has been overtaken.
void forget_earlier_presence(self_pointer self, const node_identity& who) {
  auto& presences = self->state.presences;
  const auto i = presences.find(who.uuid);
  if (i != presences.end() && i->second.epoch < who.epoch)
    presences.erase(i);
}

} // namespace

void restore_members(self_pointer self) {
  auto& st = self->state;
  for (const auto& known : st.setup.members)
    if (known.identity.uuid != st.setup.self.uuid)
      st.registry.expect(known, now_of(self));
}

void add_own_row(self_pointer self) {
  auto& st = self->state;
  registry_entry own;
  own.row.identity = st.setup.self;
  own.row.role = node_role::coordinator;
  own.row.resources.name = st.setup.self.name;
  own.skills = st.setup.skills;
  own.agent = st.setup.agent;
  st.registry.activate(std::move(own), now_of(self));
}

void measure_own_node(self_pointer self) {
  const auto& setup = self->state.setup;
  if (!setup.agent)
    return;
  self->request(setup.agent, limits::resource::collection, resource_query{})
      .then(
          [self](resource_report& x) {
            auto* own =
                self->state.registry.find_uuid(self->state.setup.self.uuid);
            x.resources.name = own->row.identity.name;
            own->row.resources = std::move(x.resources);
          },
          [self](const caf::error& why) {
            self->state.context.tell("measurement_failed",
                                     self->state.setup.self.name,
                                     {{"reason", to_failure(why).message}});
          });
}

void on_member_admitted(self_pointer self, const session_admitted& fact) {
  spawn(self->system(), self->state.context, member, fact,
        cell_coordinator_actor{self});
}

caf::result<node_registered> register_member(self_pointer self,
                                             const register_node& request) {
  auto& st = self->state;
  const auto& node = request.registration;
  if (node.identity.uuid == st.setup.self.uuid)
    return fail(
        error_code::conflict, "the node has the UUID of the coordination node",
        "/identity/uuid", "its data directory is a copy: give it an empty one");
  if (auto why = st.registry.refusal(node.identity, now_of(self)))
    return fail(error_code::conflict, *why, "/identity",
                "give the node another --name, or wait until the other one "
                "has been gone for a lease");
  std::string transfer;
  if (auto* old = st.registry.find_uuid(node.identity.uuid)) {
    transfer = old->transfer;
    if (old->member && old->member != request.member)
      self->send(old->member, close_session{"the node has registered anew"});
  }
  registry_entry entry;
  entry.row.identity = node.identity;
  entry.row.resources = node.resources;
  entry.row.resources.name = node.identity.name;
  entry.skills = node.skills;
  entry.agent = request.member;
  entry.member = request.member;
  entry.origin = node.origin;
  store_member(self, st.registry.activate(std::move(entry), now_of(self)));
  node_registered reply{st.setup.cell, st.setup.self.name, st.setup.incarnation,
                        take_up_instances(self, node)};
  self->monitor(request.member);
  st.places.erase(node.identity.uuid);
  forget_earlier_presence(self, node.identity);
  publish(self, {node.identity.uuid});
  st.context.tell("node_joined", node.identity.name,
                  {{"uuid", node.identity.uuid},
                   {"epoch", node.identity.epoch},
                   {"address", node.identity.address},
                   {"size", st.registry.active_count()}});
  settle_arrivals(self, node.identity.uuid, nullptr);
  if (!transfer.empty())
    on_node_returned(self, transfer);
  return reply;
}

caf::result<node_departed> depart_member(self_pointer self,
                                         const depart_node& request) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(request.uuid, request.member);
  if (!entry)
    return node_departed{};
  const auto name = entry->row.identity.name;
  // A node that goes with instances is expected back: they go on running.
  if (!has_instances(st, name)) {
    drop_row(self, request.uuid);
  } else {
    st.registry.deactivate(*entry, row_state::expected, request.reason,
                           now_of(self));
    publish(self, {request.uuid});
  }
  stop_searches_on(st, name);
  st.context.tell(
      "node_left", name,
      {{"reason", request.reason}, {"size", st.registry.active_count()}});
  return node_departed{};
}

void on_member_lost(self_pointer self, const member_lost& fact) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(fact.uuid, fact.member);
  if (!entry)
    return;
  const auto name = entry->row.identity.name;
  if (entry->row.state == row_state::departing) {
    // It goes: where it turns up tells the rest.
    entry->agent = nullptr;
    entry->member = nullptr;
    return on_row_vacated(self, fact.uuid);
  }
  st.registry.deactivate(*entry, row_state::lost, fact.reason, now_of(self));
  publish(self, {fact.uuid});
  stop_searches_on(st, name);
  st.context.tell(
      "node_lost", name,
      {{"reason", fact.reason}, {"size", st.registry.active_count()}});
  on_row_vacated(self, fact.uuid);
}

void on_member_down(self_pointer self, const caf::actor_addr& gone) {
  std::vector<member_lost> losses;
  self->state.registry.for_each([&](registry_entry& entry) {
    if (entry.member && entry.member.address() == gone)
      losses.push_back({entry.row.identity.uuid, entry.member,
                        "the part that spoke with it has failed"});
  });
  for (const auto& loss : losses)
    on_member_lost(self, loss);
}

} // namespace roscell
