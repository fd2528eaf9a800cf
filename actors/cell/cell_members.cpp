#include "actors/cell/cell_members.hpp"

#include "actors/cell/state/arrivals.hpp"
#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/house/limits.hpp"
#include "actors/placement/reservation.hpp"
#include "actors/session/member.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;

/// Keep, stop or start: what shall become of the instances of a node that
/// registers, given what it runs and what the tasks want of it.
std::vector<instance_verdict> reconcile(const cell_coordinator_state& st,
                                        const node_registration& node) {
  std::vector<instance_verdict> result;
  for (const auto& x : node.instances) {
    const auto& id = x.spec.instance;
    const bool wanted = st.tasks.find_spec(id, node.identity.name) != nullptr;
    result.push_back({id, wanted ? verdict::keep : verdict::stop, {}});
  }
  for (const auto& spec : st.tasks.wanted_on(node.identity.name)) {
    const bool known = std::any_of(
        node.instances.begin(), node.instances.end(),
        [&](const auto& x) { return x.spec.instance == spec.instance; });
    if (!known)
      result.push_back({spec.instance, verdict::start, {spec}});
  }
  return result;
}

/// What of a node's instances belongs to a task of this cell.
std::vector<instance_row> kept_rows(const cell_coordinator_state& st,
                                    const node_registration& node) {
  std::vector<instance_row> result;
  for (auto x : node.instances) {
    if (!st.tasks.find_spec(x.spec.instance, node.identity.name))
      continue;
    x.node = node.identity.name;
    result.push_back(std::move(x));
  }
  return result;
}

/// Carries out a verdict on the coordination node itself. How it went is told
/// by the instance's own changes.
void apply_here(self_pointer self, const node_registration& own,
                const instance_verdict& x) {
  const auto ignore = [](const caf::error&) {};
  const auto& agent = self->state.setup.agent;
  if (x.what == verdict::start)
    self->request(agent, limits::task::deployment_answer,
                  instance_deployment{x.spec.front()})
        .then([](const instance_deployed&) {}, ignore);
  if (x.what != verdict::stop)
    return;
  for (const auto& known : own.instances)
    if (known.spec.instance == x.instance)
      self->request(agent, limits::task::removal_answer,
                    instance_removal{known.spec.task, x.instance})
          .then([](const instances_removed&) {}, ignore);
}

/// Resources of one cell, as the answers come in.
struct resource_tally {
  cell_resources result;
  size_t open = 0;
  caf::typed_response_promise<cell_resources> promise;

  void finish_one() {
    if (--open > 0)
      return;
    auto& nodes = result.nodes;
    std::sort(nodes.begin(), nodes.end(),
              [](const auto& x, const auto& y) { return x.name < y.name; });
    promise.deliver(std::move(result));
  }
};

void stop_searches_on(const cell_coordinator_state& st,
                      const std::string& node) {
  if (st.setup.searches)
    st.setup.searches->node_left(node);
}

/// Adds what deploying tasks hold on a node whose instances it has not reported
/// yet, unless its report counts them as reserved.
void reserve_intents(const cell_coordinator_state& st,
                     const std::vector<std::string>& counted,
                     node_resources& node) {
  const std::set<std::string> reserved{counted.begin(), counted.end()};
  for (const auto& [task, entry] : st.tasks.entries()) {
    const auto& record = entry.record;
    for (size_t i = 0; i < record.specs.size(); ++i)
      if (record.nodes[i] == node.name
          && reserved.count(record.specs[i].instance) == 0
          && !st.registry.find_instance(record.specs[i].instance))
        reserve(node, record.specs[i].resources, record.specs[i].gpu);
  }
}

/// The instances that tasks want on a node and that it has not told of yet.
std::set<std::string> untold_on(const cell_coordinator_state& st,
                                const std::string& node) {
  std::set<std::string> result;
  for (const auto& [task, entry] : st.tasks.entries()) {
    const auto& record = entry.record;
    for (size_t i = 0; i < record.specs.size(); ++i)
      if (record.nodes[i] == node
          && !st.registry.find_instance(record.specs[i].instance))
        result.insert(record.specs[i].instance);
  }
  return result;
}

void on_report(self_pointer self, const std::string& uuid,
               resource_report report, resource_tally& tally) {
  auto* entry = self->state.registry.find_uuid(uuid);
  if (entry && entry->row.state == row_state::active) {
    report.resources.name = entry->row.identity.name;
    entry->row.resources = report.resources;
    reserve_intents(self->state, report.reserved, report.resources);
    tally.result.nodes.push_back(std::move(report.resources));
  }
  tally.finish_one();
}

void ask_for_resources(self_pointer self, const std::string& uuid,
                       const std::shared_ptr<resource_tally>& tally,
                       int rounds) {
  auto* entry = self->state.registry.find_uuid(uuid);
  if (rounds == 0 || !entry || !entry->agent)
    return tally->finish_one();
  const auto name = entry->row.identity.name;
  const auto before = untold_on(self->state, name);
  self->request(entry->agent, limits::resource::collection, resource_query{})
      .then(
          [=](resource_report& x) {
            // Nobody knows whether the report counts an instance that came up
            // while it was on its way. The next one does.
            const auto after = untold_on(self->state, name);
            if (std::includes(after.begin(), after.end(), before.begin(),
                              before.end()))
              on_report(self, uuid, std::move(x), *tally);
            else
              ask_for_resources(self, uuid, tally, rounds - 1);
          },
          [tally](const caf::error&) { tally->finish_one(); });
}

registry_entry entry_of(const register_node& request) {
  const auto& node = request.registration;
  registry_entry result;
  result.row.identity = node.identity;
  result.row.resources = node.resources;
  result.row.resources.name = node.identity.name;
  result.skills = node.skills;
  result.agent = request.member;
  result.member = request.member;
  result.origin = node.origin;
  return result;
}

/// The row may be shown now.
void on_registration_kept(
    self_pointer self, const register_node& request,
    caf::typed_response_promise<node_registered> promise) {
  auto& st = self->state;
  const auto& node = request.registration;
  const auto& who = node.identity;
  std::string transfer;
  member_actor former;
  if (const auto* old = st.registry.find_uuid(who.uuid)) {
    transfer = old->transfer;
    former = old->member;
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
  entry->row.instances = kept_rows(st, node);
  st.places.erase(who.uuid);
  st.free_nodes.registered(who);
  publish(self, {who.uuid});
  st.context.tell("node_joined", who.name,
                  {{"uuid", who.uuid},
                   {"epoch", who.epoch},
                   {"address", who.address},
                   {"size", st.registry.active_count()}});
  promise.deliver(node_registered{st.setup.cell, st.setup.self.name,
                                  st.setup.incarnation, reconcile(st, node)});
  settle_arrivals(self, who.uuid, nullptr);
  if (!transfer.empty())
    on_node_returned(self, transfer);
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

void reconcile_own_node(self_pointer self) {
  const auto& st = self->state;
  if (!st.setup.supervisor)
    return;
  self->request(st.setup.supervisor, limits::resource::collection,
                instance_query{})
      .then(
          [self](instance_description& known) {
            node_registration own;
            own.identity = self->state.setup.self;
            own.instances = std::move(known.instances);
            for (const auto& row : kept_rows(self->state, own))
              self->state.registry.update_instance(row);
            for (const auto& x : reconcile(self->state, own))
              apply_here(self, own, x);
          },
          [self](const caf::error& why) {
            self->state.context.tell("reconciliation_failed",
                                     self->state.setup.self.name,
                                     {{"reason", to_failure(why).message}});
          });
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
  const auto& who = request.registration.identity;
  if (who.uuid == st.setup.self.uuid)
    return fail(error_code::conflict,
                "this UUID is in use at " + st.setup.self.address
                    + ", by the coordination node: its data directory is a "
                      "copy",
                "/identity/uuid",
                "start this node with another --data-dir, or with this one "
                "emptied: then it makes a UUID of its own");
  if (auto why = st.registry.refusal(who, now_of(self)))
    return to_error(*why);
  auto promise = self->make_response_promise<node_registered>();
  const bool known = st.registry.is_known(who, request.registration.origin);
  self->monitor(request.member);
  keep_records(
      self, st.registry.propose(entry_of(request)),
      [=] { on_registration_kept(self, request, promise); },
      [=](const failure& why) {
        // What is on disk will do: only the epoch there is an older one.
        if (known)
          return on_registration_kept(self, request, promise);
        self->state.registry.withdraw(request.registration.identity.uuid,
                                      request.member);
        auto answer = promise;
        answer.deliver(to_error(why));
      });
  return promise;
}

caf::result<node_departed> depart_member(self_pointer self,
                                         const depart_node& request) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(request.uuid, request.member);
  if (!entry)
    return node_departed{};
  const auto name = entry->row.identity.name;
  // A node that goes with instances is expected back: they go on running.
  if (entry->row.instances.empty()) {
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
    return set_timer(self);
  }
  st.registry.deactivate(*entry, row_state::lost, fact.reason, now_of(self));
  publish(self, {fact.uuid});
  stop_searches_on(st, name);
  st.context.tell(
      "node_lost", name,
      {{"reason", fact.reason}, {"size", st.registry.active_count()}});
  // It may have said publicly that it is in no cell before that was known.
  set_timer(self);
}

void on_member_down(self_pointer self, const caf::actor_addr& gone) {
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

void on_instance_changed(self_pointer self, const instance_changed& fact) {
  auto& st = self->state;
  const auto& x = fact.instance;
  const bool wanted = st.tasks.find_spec(x.spec.instance, x.node) != nullptr;
  if (wanted || is_live(x.state))
    st.registry.update_instance(x);
  else
    st.registry.erase_instance(x.spec.instance);
  json data{{"task", x.spec.task},
            {"step", x.spec.step},
            {"node", x.node},
            {"state", to_word(x.state)}};
  if (!x.reason.empty())
    data["reason"] = x.reason;
  if (x.exit_code >= 0)
    data["exit_code"] = x.exit_code;
  st.context.tell("instance_changed", x.spec.instance, data);
}

caf::result<cell_resources> collect_cell_resources(self_pointer self) {
  auto promise = self->make_response_promise<cell_resources>();
  auto tally = std::make_shared<resource_tally>();
  tally->promise = promise;
  tally->open = self->state.registry.active_count();
  self->state.registry.for_each_active([&](registry_entry& entry) {
    ask_for_resources(self, entry.row.identity.uuid, tally,
                      limits::resource::rounds);
  });
  return promise;
}

} // namespace roscell
