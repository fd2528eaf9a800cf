#include "actors/core/answer_limits.hpp"
#include "actors/membership/membership_steps.hpp"
#include "actors/session/registration_client.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

std::optional<caf::error> refusal(const membership_status& st,
                                  const registration_switch& order) {
  const auto& me = st.config.identity;
  if (order.node != me.name || order.uuid != me.uuid)
    return fail(error_code::unknown_node,
                "this is node '" + me.name + "' with UUID " + me.uuid, "/node");
  if (st.switching || st.phase == phase::accepting
      || st.phase == phase::leaving)
    return fail(error_code::conflict,
                "node '" + me.name + "' is " + std::string{to_word(st.state)}
                    + " already",
                "", "ask again when it has come to rest");
  if (order.epoch != me.epoch)
    return fail(error_code::conflict,
                "the switch is for epoch " + std::to_string(order.epoch)
                    + ", and node '" + me.name + "' is at epoch "
                    + std::to_string(me.epoch),
                "/epoch", "ask the node for its present epoch first");
  return std::nullopt;
}

/// From here on only the new registration counts.
void go_independent(self_pointer self) {
  auto& st = self->state;
  st.seeking = false;
  st.wanted.clear();
  finish_leaving(self);
  show_presence(self);
}

void go_to_target(self_pointer self) {
  auto& st = self->state;
  drop_session(self, "it goes to another cell");
  self->send(st.parts.discovery, forget_coordinator{});
  const auto& order = st.switching->order;
  st.wanted = order.target.front().discovery_server;
  st.origin = order.origin;
  st.pause.reset();
  begin_attempt(self);
}

/// Ends what an orphan runs: it carries the address of the old cell's server.
void end_instances(self_pointer self) {
  self->request(self->state.parts.supervisor, limits::local::part,
                instance_query{})
      .then(
          [self](const instance_description& known) {
            for (const auto& x : known.instances)
              self->request(self->state.parts.agent, limits::task::removal,
                            instance_removal{x.spec.task, x.spec.instance})
                  .then([](const instances_removed&) {},
                        [](const caf::error&) {
                          // The new cell's verdict ends what is left.
                        });
          },
          [](const caf::error&) {
            // The same.
          });
}

void depart(self_pointer self) {
  auto& st = self->state;
  const auto& order = st.switching->order;
  publish_event(
      self, events::switch_accepted,
      {{"transfer", order.transfer},
       {"cell", order.target.empty() ? "" : order.target.front().cell},
       {"epoch", st.config.identity.epoch}});
  if (st.switching->state == node_state::orphaned)
    end_instances(self);
  if (order.target.empty())
    go_independent(self);
  else
    go_to_target(self);
}

/// The switch could not be written down, so it does not happen. Who rested
/// rests again; an attempt that was ended for it begins anew, at once.
void stay(self_pointer self) {
  auto& st = self->state;
  const auto before = *std::exchange(st.switching, std::nullopt);
  st.state = before.state;
  if (before.phase == phase::joined && st.session) {
    st.phase = phase::joined;
  } else if (before.phase == phase::resting) {
    st.phase = phase::resting;
    // A coordinator may have appeared meanwhile.
    if (st.seeking)
      return seek_slot(self);
  } else {
    // Its session was lost meanwhile.
    if (before.state == node_state::member)
      st.state = node_state::orphaned;
    st.phase = phase::waiting;
    st.deadline = self->clock().now();
  }
  set_timer(self);
}

membership_record record_of(const membership_status& st) {
  membership_record result;
  result.configured = st.config.configured;
  if (st.state == node_state::member) {
    result.discovery_server = st.wanted;
    result.cell = st.cell;
    result.cell_uuid = st.cell_uuid;
    result.origin = st.origin;
    if (const auto port = program_port(st); port != 0) {
      result.discovery = {st.programs->place};
      result.discovery_port = port;
      result.server_cell = st.programs->cell_uuid;
    }
  }
  return result;
}

store_record to_store(const membership_record& x) {
  return {"identity", "membership", json(x).dump(), true};
}

/// Whether the switch that is being written down is wanted still: the node may
/// have been told to leave its cell meanwhile.
bool is_accepting(const membership_status& st, const std::string& transfer) {
  return st.phase == phase::accepting && st.switching
         && st.switching->order.transfer == transfer;
}

/// What is on disk counts, whether the node goes or not.
void take_up(membership_status& st, const node_identity& raised,
             const std::optional<membership_record>& record) {
  st.config.identity.epoch = std::max(st.config.identity.epoch, raised.epoch);
  if (record)
    st.stored = record;
}

void on_switch_written(self_pointer self, const std::string& transfer,
                       const switch_reply& reply) {
  auto& st = self->state;
  if (!is_accepting(st, transfer))
    return reply(fail(error_code::conflict,
                      "node '" + st.config.identity.name
                          + "' left its cell before the switch was written "
                            "down",
                      "/node", "ask again when it has come to rest"));
  reply(switch_accepted{st.config.identity.epoch});
  depart(self);
}

/// Writes the raised epoch; a released node also writes that it is released,
/// so that it does not come back when it is started again.
void write_down(self_pointer self, const switch_reply& reply) {
  auto& st = self->state;
  const auto transfer = st.switching->order.transfer;
  auto raised = st.config.identity;
  ++raised.epoch;
  std::optional<membership_record> record;
  store_records records{{{"identity", "node", json(raised).dump(), true}}};
  if (st.switching->order.target.empty()) {
    record = record_of(st);
    records.records.push_back(to_store(*record));
  }
  self->request(st.parts.store, limits::local::part, records)
      .then(
          [=](const record_stored&) {
            take_up(self->state, raised, record);
            on_switch_written(self, transfer, reply);
          },
          [=](const caf::error& why) {
            if (is_accepting(self->state, transfer))
              stay(self);
            reply(why);
          });
}

void accept(self_pointer self, const registration_switch& order,
            const switch_reply& reply) {
  auto& st = self->state;
  if (st.phase != phase::joined) {
    // An attempt that is under way ends here.
    ++st.attempt;
    drop_session(self, "it has been sent elsewhere");
    self->send(st.parts.discovery, forget_coordinator{});
  }
  const auto before =
      st.state == node_state::joining ? node_state::independent : st.state;
  st.switching = switch_attempt{order, before, st.phase, st.wanted, st.origin};
  st.last_switch = order.transfer;
  st.state = node_state::switching;
  st.phase = phase::accepting;
  write_down(self, reply);
}

bool is_repetition(const membership_status& st,
                   const registration_switch& order) {
  return order.transfer == st.last_switch
         && order.node == st.config.identity.name
         && order.uuid == st.config.identity.uuid;
}

} // namespace

caf::result<registration_challenge>
make_challenge(self_pointer self, const registration_query& query) {
  auto& st = self->state;
  const auto token = st.config.site.text();
  if (!proves(status_question{query.nonce}, token, query.proof))
    return fail(error_code::unauthorized,
                "who asks where this node stands proves that he has its site "
                "token",
                "/proof", "ask with a nonce and a proof over it");
  const auto& me = st.config.identity;
  registration_challenge result;
  result.node = me.name;
  result.uuid = me.uuid;
  result.epoch = me.epoch;
  result.state = to_word(st.state);
  result.nonce = st.challenges.issue(self->clock().now());
  result.proof =
      prove(status_claim{query.nonce, me.name, me.uuid, me.epoch, result.state},
            token);
  return result;
}

void on_proven_switch(self_pointer self, const registration_switch& order,
                      switch_reply reply) {
  auto& st = self->state;
  const auto now = self->clock().now();
  if (!st.challenges.is_fresh(order.nonce, now)
      || !proves(order_of(order), st.config.site.text(), order.proof))
    return reply(fail(error_code::unauthorized,
                      "the switch is not proven with the site token and a "
                      "nonce of this node that is still good",
                      "/proof", "ask for a registration_challenge first"));
  st.challenges.spend(order.nonce, now);
  if (is_repetition(st, order))
    return reply(switch_accepted{st.config.identity.epoch});
  if (auto why = refusal(st, order))
    return reply(std::move(*why));
  if (st.state == node_state::member)
    return reply(fail(error_code::unauthorized,
                      "node '" + order.node + "' is a member of cell '"
                          + st.cell + "': only its coordinator can switch it",
                      "", "ask a coordinator for a node_transfer"));
  accept(self, order, reply);
}

void on_coordinators_switch(self_pointer self, const registration_switch& order,
                            switch_reply reply) {
  auto& st = self->state;
  if (is_repetition(st, order))
    return reply(switch_accepted{st.config.identity.epoch});
  if (auto why = refusal(st, order))
    return reply(std::move(*why));
  if (st.phase != phase::joined)
    return reply(fail(error_code::conflict, "this node is not registered yet"));
  accept(self, order, reply);
}

bool give_up_switch(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  if (!st.switching)
    return false;
  const auto before = *std::exchange(st.switching, std::nullopt);
  publish_event(self, events::switch_failed,
                {{"transfer", before.order.transfer},
                 {"cell", before.order.target.front().cell},
                 {"reason", reason}});
  st.wanted = before.wanted;
  st.origin = before.origin;
  // It has no session with its old coordinator any more, but goes back there.
  st.state =
      before.state == node_state::member ? node_state::orphaned : before.state;
  st.pause.reset();
  retreat(self, reason, std::chrono::milliseconds{0});
  return true;
}

void store_membership(self_pointer self) {
  auto& st = self->state;
  const auto record = record_of(st);
  if (st.stored == record)
    return;
  st.stored = record;
  self->request(st.parts.store, limits::local::part, to_store(record))
      .then([](const record_stored&) {},
            [self](const caf::error&) {
              // The state store has told of it; written again at the next
              // registration.
              self->state.stored.reset();
            });
}

} // namespace roscell::membership_steps
