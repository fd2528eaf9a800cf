#include "actors/cell/cell_members.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/moves/abandoned_steps.hpp"
#include "actors/cell/skill_additions.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/member_presence.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/tasks/cell_instances.hpp"
#include "actors/cell/tasks/parameter_changes.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/session/member/member.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

using registration_promise = caf::typed_response_promise<node_registered>;

void stop_searches_on(const cell_coordinator_state& st,
                      const std::string& node) {
  if (st.setup.searches)
    st.setup.searches->node_left(node);
}

registry_entry entry_of(const cell_coordinator_state& st,
                        const register_node& request) {
  const auto& node = request.registration;
  registry_entry result;
  const bool is_ours =
      !node.server_cell.empty() && node.server_cell == st.setup.cell_uuid;
  result.server_id =
      st.registry.choose_server_id(node.identity.uuid, node.server_id, is_ours,
                                   st.setup.server_id, st.peers.server_ids());
  result.row.identity = node.identity;
  result.row.resources = node.resources;
  result.row.resources.name = node.identity.name;
  result.skills = node.skills;
  result.refused_skills = node.refused_skills;
  result.agent = request.member;
  result.member = request.member;
  result.origin = node.origin;
  result.fetches_builds = node.fetches_builds;
  result.build_key = node.fetches_builds ? new_build_key() : std::string{};
  return result;
}

std::vector<discovery_place> place_of(const cell_coordinator_state& st,
                                      const registry_entry& entry) {
  if (entry.server_id < 0)
    return {};
  return {{entry.server_id, st.setup.ros_domain_id, st.setup.discovery_server,
           st.setup.server_id}};
}

/// Two members at one address: two hosts that have the same one, of which
/// others reach now one and now the other, or a host whose address another one
/// has got before it was missed.
void publish_shared_address(coordinator_pointer self,
                            const node_identity& who) {
  if (who.address.empty())
    return;
  self->state.registry.for_each_active([&](const registry_entry& x) {
    const auto& other = x.row.identity;
    if (other.uuid != who.uuid && other.address == who.address)
      self->state.context.publish_event(
          events::address_shared, who.name,
          {{"address", who.address},
           {"with", other.name},
           {"hint", "if both hosts run, give each an address of its own"}});
  });
}

/// The row may be shown now.
void on_registration_persisted(coordinator_pointer self,
                               const register_node& request,
                               registration_promise promise) {
  auto& st = self->state;
  const auto& node = request.registration;
  const auto& who = node.identity;
  member_actor former;
  std::string former_name = who.name;
  if (const auto* old = st.registry.find_uuid(who.uuid)) {
    former = old->member;
    former_name = old->row.identity.name;
  }
  auto* entry = st.registry.accept(who.uuid, request.member, now_of(self));
  if (!entry) {
    promise.deliver(
        fail(error_code::conflict,
             "the node has registered anew, or its session has ended"));
    return;
  }
  if (former && former != request.member)
    self->send(former, close_session{"the node has registered anew"});
  st.slots.forget(who.uuid);
  st.unassigned_nodes.registered(who);
  if (former_name != who.name)
    rename_node(self, former_name, who.name);
  st.sets.forgive(who.name);
  publish(self, {who.uuid});
  st.context.publish_event(events::node_joined, who.name,
                           {{"uuid", who.uuid},
                            {"epoch", who.epoch},
                            {"address", who.address},
                            {"size", st.registry.active_count()}});
  publish_shared_address(self, who);
  promise.deliver(
      node_registered{st.setup.cell, st.setup.self.name, st.setup.incarnation,
                      take_up_instances(self, node), st.setup.cell_uuid,
                      place_of(st, *entry), true, true, entry->build_key});
  restate_parameters(self, node);
  release_remains(self, who.name);
  settle_arrivals(self, who.uuid, {});
  on_node_returned(self, who.uuid);
  // What it still runs of late tasks is ended.
  st.deadlines.hurry(self->clock().now());
  set_timer(self);
}

/// Writes the row down, unless it cannot have one. A member that has `gone`
/// does not stand in its way.
void admit(coordinator_pointer self, const register_node& request,
           const member_actor& gone, registration_promise promise) {
  auto& st = self->state;
  const auto& who = request.registration.identity;
  if (auto why = st.registry.refusal(who, now_of(self), gone)) {
    st.context.publish_event(events::node_refused, who.name,
                             {{"uuid", who.uuid},
                              {"address", who.address},
                              {"reason", why->message},
                              {"hint", why->hint}});
    promise.deliver(to_error(*why));
    return;
  }
  auto entry = entry_of(st, request);
  const bool known = st.registry.is_known(who, entry.origin, entry.server_id);
  const auto go_on = [=, server_id = entry.server_id] {
    meet_member_server(self, server_id, request.registration.tells_anew, [=] {
      on_registration_persisted(self, request, promise);
    });
  };
  watch_until_its_end(self, request.member);
  keep_records(self, st.registry.propose(std::move(entry)), go_on,
               [=](const failure& why) {
                 // What is on disk will do: only the epoch there is an older
                 // one.
                 if (known)
                   return go_on();
                 const auto& uuid = request.registration.identity.uuid;
                 self->state.registry.withdraw(uuid, request.member);
                 if (!self->state.registry.expects(uuid))
                   forget_refused(self, "members", uuid);
                 auto answer = promise;
                 answer.deliver(to_error(why));
               });
}

/// Nothing is heard of a node any more, and was not for some time.
void fail_node(coordinator_pointer self, const registry_entry& entry,
               std::chrono::milliseconds silence) {
  const auto who = entry.row.identity;
  give_up_waits_on(self, who.name);
  abandon_steps_of(self, who.name, who.uuid, self->clock().now() - silence);
  for (const auto& spec : self->state.deployments.bound_to(who.name))
    publish_task_event(self, events::instance_out_of_reach, spec.task,
                       spec.instance,
                       {{"task", spec.task},
                        {"step", spec.step},
                        {"node", who.name},
                        {"reason", entry.row.reason},
                        {"on_node_loss", spec.life.on_node_loss}});
}

} // namespace

void restore_members(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& known : st.setup.members)
    if (known.identity.uuid != st.setup.self.uuid)
      st.registry.expect(known, now_of(self));
}

void add_own_row(coordinator_pointer self) {
  auto& st = self->state;
  registry_entry own;
  own.row.identity = st.setup.self;
  own.row.role = node_role::coordinator;
  own.row.resources.name = st.setup.self.name;
  own.skills = st.setup.skills;
  own.refused_skills = st.setup.refused_skills;
  own.agent = st.setup.agent;
  own.fetches_builds = static_cast<bool>(st.setup.keeper);
  own.build_key = st.setup.build_key;
  st.registry.activate(std::move(own), now_of(self));
}

void measure_own_node(coordinator_pointer self) {
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
            look_at_sets(self);
          },
          [self](const caf::error& why) {
            self->state.context.publish_event(
                events::measurement_failed, self->state.setup.self.name,
                {{"reason", to_failure(why).message}});
          });
}

void on_member_admitted(coordinator_pointer self,
                        const session_admitted& event) {
  spawn(self->system(), self->state.context, member, event,
        cell_coordinator_actor{self});
}

caf::result<node_registered> register_member(coordinator_pointer self,
                                             const register_node& request) {
  auto& st = self->state;
  const auto& who = request.registration.identity;
  if (who.uuid == st.setup.self.uuid)
    return fail(error_code::conflict,
                "this UUID is in use at " + st.setup.self.address
                    + ", by the coordination node: its data directory is a "
                      "copy",
                "/identity/uuid",
                "start this node once with --new-identity: then it makes a "
                "UUID of its own");
  const auto& cell = request.registration.cell_uuid;
  if (!cell.empty() && cell != st.setup.cell_uuid)
    return fail(error_code::unknown_cell,
                "this is another cell '" + st.setup.cell
                    + "' than the one that the node was in",
                "/cell_uuid",
                "it waits for its own; to take it over, name it in a "
                "cell_formation");
  auto promise = self->make_response_promise<node_registered>();
  const auto rival = st.registry.rival_of(who);
  if (!rival)
    admit(self, request, rival, promise);
  else
    prove_member(self, rival, [=](bool is_there) {
      admit(self, request, is_there ? member_actor{} : rival, promise);
    });
  return promise;
}

caf::result<node_departed> depart_member(coordinator_pointer self,
                                         const depart_node& request) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(request.uuid, request.member);
  if (!entry) {
    // It may go before its registration has been written down.
    st.registry.withdraw(request.uuid, request.member);
    return node_departed{};
  }
  const auto name = entry->row.identity.name;
  // A node that goes with instances is expected back: they go on running.
  if (!has_instances(st, name)) {
    drop_row(self, request.uuid);
  } else {
    st.registry.deactivate(*entry, row_state::expected, request.reason,
                           now_of(self));
    follow_member_server(self, *entry, server_contact::lost);
    fail_node(self, *entry, std::chrono::milliseconds{0});
    publish(self, {request.uuid});
  }
  stop_searches_on(st, name);
  st.context.publish_event(
      events::node_left, name,
      {{"reason", request.reason}, {"size", st.registry.active_count()}});
  return node_departed{};
}

void on_member_lost(coordinator_pointer self, const member_lost& event) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(event.uuid, event.member);
  if (!entry)
    return;
  follow_member_server(self, *entry, server_contact::lost);
  if (std::chrono::milliseconds{event.silent_ms} >= limits::lease::span)
    doubt_silent_host(self, *entry);
  const auto name = entry->row.identity.name;
  const bool departing = entry->row.state == row_state::departing;
  if (departing && !fail_departing_node(self, *entry, event.reason)) {
    give_up_waits_on(self, name);
    abandon_steps_of(self, name, event.uuid, self->clock().now());
    return set_timer(self);
  }
  if (!departing)
    st.registry.deactivate(*entry, row_state::lost, event.reason, now_of(self));
  fail_node(self, *entry, std::chrono::milliseconds{event.silent_ms});
  publish(self, {event.uuid});
  stop_searches_on(st, name);
  publish_node_lost(self, *entry);
  // It may have said publicly that it is in no cell before that was known.
  set_timer(self);
}

void on_member_down(coordinator_pointer self, const caf::actor_addr& gone) {
  self->state.registry.withdraw(gone);
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
