#include "actors/cell/cell_slots.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

using outcome_done = std::function<void(formation_outcome)>;

formation_outcome failed(const std::string& node, const failure& why) {
  formation_outcome result;
  result.node = node;
  result.code = to_word(why.code);
  result.message = why.message;
  result.hint = why.hint;
  return result;
}

formation_outcome joined(const std::string& node, const std::string& from) {
  formation_outcome result;
  result.node = node;
  result.result = formation_result::joined;
  result.from = from;
  return result;
}

/// Answers when the node has a row that is active, or when it took too long.
void answer_on_arrival(coordinator_pointer self, const std::string& uuid,
                       const formation_outcome& success,
                       const outcome_done& done) {
  await_arrival(self, uuid, [success, done](const completion& came) {
    done(came ? success : failed(success.node, came.error()));
  });
}

/// Brings in a node that is in no cell, by its REST API.
void bring_in_unassigned(coordinator_pointer self, const node_presence& who,
                         const outcome_done& done) {
  auto& st = self->state;
  auto kept = reserve_here(
      self, {who.name, who.uuid, who.epoch,
             std::chrono::milliseconds{limits::cell::invited_place}.count()});
  if (!kept)
    return done(failed(who.name, to_failure(kept.error())));
  registration_switch order;
  order.transfer = st.transfers.new_id();
  order.node = who.name;
  order.uuid = who.uuid;
  order.epoch = who.epoch;
  order.target = {own_address(st.setup)};
  answer_on_arrival(self, who.uuid, joined(who.name, ""), done);
  self->request(st.setup.registration, limits::cell::invitation,
                switch_node{who.address, order})
      .then([](const switch_accepted&) {},
            [self, who](const caf::error& err) {
              auto& state = self->state;
              auto* entry = state.registry.find_uuid(who.uuid);
              if (entry && entry->row.state == row_state::reserved)
                drop_row(self, who.uuid);
              const auto why = to_failure(err);
              // What it announced may be long out of date.
              if (why.code == error_code::unreachable)
                state.unassigned_nodes.forget(who.uuid);
              settle_arrivals(self, who.uuid, why);
            });
}

/// Has another coordinator transfer a member of its cell to this one.
void bring_over(coordinator_pointer self, const peer_actor& holder,
                const std::string& node, instance_policy policy,
                const outcome_done& done) {
  node_transfer order;
  order.node = node;
  order.target = self->state.setup.cell;
  order.instances = policy;
  order.forwarded = true;
  self->request(holder, limits::transfer::forwarded, order)
      .then([done](const node_transferred& x) { done(joined(x.node, x.from)); },
            [node, done](const caf::error& why) {
              done(failed(node, to_failure(why)));
            });
}

/// What becomes of a node that has a row here; false if it has none that
/// settles it.
bool settle_known(coordinator_pointer self, const std::string& node,
                  const outcome_done& done) {
  auto& st = self->state;
  const auto* entry = st.registry.find_name(node);
  if (!entry)
    return false;
  const auto& row = entry->row;
  formation_outcome result;
  result.node = node;
  switch (row.state) {
  case row_state::active:
    result.result = formation_result::already_member;
    done(result);
    return true;
  case row_state::reserved:
    answer_on_arrival(self, row.identity.uuid, joined(node, ""), done);
    return true;
  case row_state::departing:
    done(failed(node,
                {error_code::conflict, "node '" + node + "' is departing", "",
                 "its transfer is '" + st.transfers.holder_of(row.identity.uuid)
                     + "'"}));
    return true;
  default:
    return false;
  }
}

/// A row of this cell whose node is away and does not say that it is free.
failure is_away(const registry_row& row) {
  return {error_code::unreachable,
          "node '" + row.identity.name + "' is "
              + std::string{to_word(row.state)},
          "", "try again when it is back"};
}

failure coordinates(const std::string& node) {
  return {error_code::conflict,
          "'" + node
              + "' coordinates a cell: a coordination node cannot leave its "
                "cell"};
}

failure is_invisible(const std::string& node) {
  return {error_code::unknown_node, "no node '" + node + "' is visible", "",
          "start it, with --peer where multicast does not reach"};
}

failure is_ambiguous(const node_presence& who, const named_node& found) {
  return {error_code::conflict,
          "a node '" + who.name + "' at " + who.address
              + " is in no cell, and cell '" + found.cell
              + "' has another one of that name",
          "", "give one of them another --name"};
}

/// Where the nodes in no cell are that announce the name.
std::vector<std::string> free_addresses(const cell_coordinator_state& st,
                                        const std::string& node) {
  std::vector<std::string> result;
  for (const auto& x : st.unassigned_nodes.rows())
    if (x.name == node && x.silent_since_unix_ms == 0)
      result.push_back(x.address);
  return result;
}

/// It is for a person to say which one is meant.
failure are_twins(const std::string& node,
                  const std::vector<std::string>& addresses) {
  std::string where;
  for (const auto& x : addresses)
    where += (where.empty() ? "" : ", ") + x;
  return {error_code::conflict,
          "several nodes in no cell are called '" + node + "': at " + where, "",
          "start one of them with another --name"};
}

/// Brings in a node that has no row here.
void bring_in_unauthenticated(coordinator_pointer self, const std::string& node,
                              instance_policy policy,
                              const outcome_done& done) {
  const auto& st = self->state;
  const auto found = find_elsewhere(st, node);
  const auto* who = st.unassigned_nodes.find_name(node);
  if (!found.why.message.empty())
    return done(failed(node, found.why));
  if (!found.holder && !who)
    return done(failed(node, is_invisible(node)));
  if (const auto twins = free_addresses(st, node); twins.size() > 1)
    return done(failed(node, are_twins(node, twins)));
  if (!found.holder)
    return bring_in_unassigned(self, node_presence{*who}, done);
  if (who && who->uuid != found.claim.uuid)
    return done(failed(node, is_ambiguous(*who, found)));
  // A node that says itself that it is in no cell knows best, unless a cell has
  // news that are newer.
  if (who && who->epoch >= found.claim.epoch)
    return bring_in_unassigned(self, node_presence{*who}, done);
  bring_over(self, found.holder, node, policy, done);
}

void bring_in(coordinator_pointer self, const std::string& node,
              instance_policy policy, const outcome_done& done) {
  const auto& st = self->state;
  if (settle_known(self, node, done))
    return;
  if (node == st.setup.self.name || st.peers.is_announced(node))
    return done(failed(node, coordinates(node)));
  const auto* entry = st.registry.find_name(node);
  if (!entry)
    return bring_in_unauthenticated(self, node, policy, done);
  const auto* who = st.unassigned_nodes.find(entry->row.identity.uuid);
  if (who)
    bring_in_unassigned(self, node_presence{*who}, done);
  else
    done(failed(node, is_away(entry->row)));
}

} // namespace

caf::result<cell_formed> form_cell(coordinator_pointer self,
                                   const cell_formation& request) {
  struct tally {
    size_t open = 1;
    cell_formed result;
  };
  auto promise = self->make_response_promise<cell_formed>();
  auto state = std::make_shared<tally>();
  state->result.cell = self->state.setup.cell;
  state->result.outcomes.resize(request.members.size());
  auto finish_one = [state, promise]() mutable {
    if (--state->open == 0)
      promise.deliver(std::move(state->result));
  };
  for (size_t i = 0; i < request.members.size(); ++i) {
    ++state->open;
    bring_in(self, request.members[i], request.instances,
             [state, i, finish_one](formation_outcome outcome) mutable {
               state->result.outcomes[i] = std::move(outcome);
               finish_one();
             });
  }
  finish_one();
  return promise;
}

} // namespace roscell
