#include "actors/cell/cell_formation.hpp"

#include "actors/cell/cell_places.hpp"
#include "actors/cell/state/arrivals.hpp"
#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/house/limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;
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
void answer_on_arrival(self_pointer self, const std::string& uuid,
                       const formation_outcome& success,
                       const outcome_done& done) {
  await_arrival(self, uuid, [success, done](const failure* why) {
    done(why ? failed(success.node, *why) : success);
  });
}

/// Brings in a node that is in no cell, by its REST API.
void bring_in_free(self_pointer self, const node_presence& who,
                   const outcome_done& done) {
  auto& st = self->state;
  auto kept = reserve_here(
      self, {who.name, who.uuid, who.epoch,
             std::chrono::milliseconds{limits::cell::invited_place}.count()});
  if (!kept)
    return done(failed(who.name, to_failure(kept.error())));
  registration_switch order;
  order.transfer = st.setup.cell + "-" + std::to_string(st.setup.incarnation)
                   + "-" + std::to_string(++st.last_transfer);
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
                state.free_nodes.forget(who.uuid);
              settle_arrivals(self, who.uuid, &why);
            });
}

/// Has another coordinator transfer a member of its cell to this one.
void bring_over(self_pointer self, const peer_entry& peer,
                const std::string& node, instance_policy policy,
                const outcome_done& done) {
  node_transfer order{node, self->state.setup.cell, policy, true};
  self->request(peer.actor, limits::transfer::forwarded, order)
      .then([done](const node_transferred& x) { done(joined(x.node, x.from)); },
            [node, done](const caf::error& why) {
              done(failed(node, to_failure(why)));
            });
}

/// What becomes of a node that has a row here; false if it has none that
/// settles it.
bool settle_known(self_pointer self, const std::string& node,
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
    done(failed(node, {error_code::conflict, "node '" + node + "' is departing",
                       "", "its transfer is '" + entry->transfer + "'"}));
    return true;
  default:
    return false;
  }
}

void bring_in(self_pointer self, const std::string& node,
              instance_policy policy, const outcome_done& done) {
  auto& st = self->state;
  if (settle_known(self, node, done))
    return;
  if (node == st.setup.self.name || st.peers.is_announced(node))
    return done(failed(node, {error_code::conflict,
                              "'" + node
                                  + "' coordinates a cell: a coordination "
                                    "node cannot leave its cell"}));
  const auto* peer = st.peers.find_holder(node);
  const auto* who = st.free_nodes.find_name(node);
  // A node that says itself that it is in no cell knows best, unless a cell has
  // news that are newer.
  int64_t known = -1;
  if (peer)
    for (const auto& [uuid, claim] : peer->members)
      if (claim.name == node)
        known = claim.epoch;
  if (who && who->epoch >= known)
    return bring_in_free(self, node_presence{*who}, done);
  if (peer)
    return bring_over(self, *peer, node, policy, done);
  const auto* entry = st.registry.find_name(node);
  if (entry)
    return done(failed(node, {error_code::unreachable,
                              "node '" + node + "' is "
                                  + std::string{to_word(entry->row.state)},
                              "", "try again when it is back"}));
  done(failed(node,
              {error_code::unknown_node, "no node '" + node + "' is visible",
               "", "start it, with --peer where multicast does not reach"}));
}

} // namespace

caf::result<cell_formed> form_cell(self_pointer self,
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
