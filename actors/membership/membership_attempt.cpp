#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/membership/join_report.hpp"
#include "actors/membership/limits.hpp"
#include "actors/membership/membership_steps.hpp"
#include "actors/session/limits.hpp"
#include "messages/event_kinds.hpp"

#include <utility>

namespace roscell::membership_steps {

namespace {

using phase = membership_phase;

bool is_refusal(error_code code) {
  return code == error_code::unauthorized || code == error_code::conflict
         || code == error_code::unknown_cell
         || code == error_code::schema_violation
         || code == error_code::unknown_type;
}

/// The handler for errors of a request that the present attempt needs.
auto give_up(self_pointer self) {
  return [self, attempt = self->state.attempt](const caf::error& why) {
    if (self->state.attempt == attempt && self->state.phase != phase::joined
        && self->state.phase != phase::leaving)
      on_error(self, why);
  };
}

// -- registering -------------------------------------------------------------

/// The coordinator has answered to what it was told, so what had ended then
/// need not be told again.
void acknowledge_ends(self_pointer self) {
  const auto& st = self->state;
  ends_acknowledged event;
  for (const auto& row : *st.instances)
    if (!is_live(row.state))
      event.instances.push_back(row.spec.instance);
  if (!event.instances.empty())
    self->send(st.parts.supervisor, std::move(event));
}

/// What the coordinator wants to go on may do so for as long as it would be
/// missed from here.
void prove_contact(self_pointer self, const node_registered& reply) {
  contact_proven event{self->state.registered_boot_ms, {}};
  for (const auto& x : reply.verdicts)
    if (x.what != verdict::stop)
      event.kept.push_back(x.instance);
  self->send(self->state.parts.supervisor, std::move(event));
}

void on_registered(self_pointer self, const node_registered& reply) {
  auto& st = self->state;
  if (reply.incarnation != st.opened->incarnation)
    return attempt_failed(self, "the coordinator has started again meanwhile");
  st.phase = phase::joined;
  st.state = node_state::member;
  st.cell = reply.cell;
  st.cell_uuid = reply.cell_uuid;
  st.coordinator = reply.coordinator;
  st.incarnation = reply.incarnation;
  st.address = st.found_address;
  st.joined_at = self->clock().now();
  st.problem.clear();
  st.report.clear();
  st.switching.reset();
  st.announced_place.clear();
  st.owes_former = false;
  withdraw_presence_now(self);
  store_membership(self);
  publish_event(self, events::cell_joined,
                {{"cell", st.cell},
                 {"coordinator", st.coordinator},
                 {"incarnation", st.incarnation},
                 {"epoch", st.config.identity.epoch}});
  acknowledge_ends(self);
  if (st.parts.permits)
    st.parts.permits->use_key(reply.build_key);
  st.gives_builds = !reply.build_key.empty();
  if (st.parts.keeper)
    self->send(st.parts.keeper, belong_to_cell{reply.cell});
  serve_programs_of(self, reply);
  prove_contact(self, reply);
  apply(self, reply.verdicts);
  for (const auto& [instance, event] : std::exchange(st.unsent, {}))
    notify(self, event);
  st.skills_heard = reply.hears_skills;
  if (std::exchange(st.skills_unsent, false))
    notify_skills(self);
}

node_registration registration_of(const membership_status& st) {
  node_registration result;
  result.identity = st.config.identity;
  result.incarnation = st.opened->incarnation;
  result.resources = *st.resources;
  result.resources.name = st.config.identity.name;
  result.skills = st.config.skills;
  result.refused_skills = st.config.refused_skills;
  result.instances = *st.instances;
  result.origin = st.origin;
  if (st.programs) {
    result.server_id = st.programs->place.server_id;
    result.server_cell = st.programs->cell_uuid;
  }
  result.tells_anew = true;
  result.fetches_builds = static_cast<bool>(st.parts.keeper);
  if (st.switching)
    result.transfer = st.switching->order.transfer;
  else if (st.state == node_state::orphaned)
    result.cell_uuid = st.cell_uuid;
  for (auto& row : result.instances) {
    row.node = st.config.identity.name;
    shorten(row);
  }
  return result;
}

/// Registers once all that it takes is there.
void maybe_register(self_pointer self) {
  auto& st = self->state;
  if (st.phase != phase::registering || !st.resources || !st.instances
      || std::exchange(st.registration_sent, true))
    return;
  auto on_result = [self](caf::expected<json> body) {
    // The calls of a session end with it, so this one is the present one.
    auto reply = body ? reply_as<node_registered>(*body) : body.error();
    if (self->state.phase != phase::registering)
      return;
    if (reply)
      on_registered(self, *reply);
    else
      on_error(self, reply.error());
  };
  st.skills_unsent = false;
  st.registered_boot_ms = st.context.boot_now_ms(self->system());
  st.frames.call(message_json(registration_of(st)),
                 self->clock().now() + limits::membership::registration,
                 on_result);
  set_timer(self);
}

/// The only cell that this attempt may end in; empty: any.
std::string expected_cell(const membership_status& st) {
  if (st.switching)
    return st.switching->order.target.front().cell;
  // The coordinator compares the UUID itself; a cell may have a new name.
  return st.state == node_state::orphaned && st.cell_uuid.empty()
             ? st.cell
             : std::string{};
}

void on_opened(self_pointer self, const session_opened& reply) {
  auto& st = self->state;
  const auto expected = expected_cell(st);
  if (!expected.empty() && reply.cell != expected) {
    self->send(reply.session, close_session{"this node is of another cell"});
    return attempt_refused(self, "cell '" + reply.cell
                                     + "' has taken the place of '" + expected
                                     + "'");
  }
  st.opened = reply;
  st.phase = phase::registering;
  take_session(self, reply.session);
  self->request(st.parts.supervisor, limits::local::part, instance_query{})
      .then(
          [self, attempt = st.attempt](const instance_description& rows) {
            if (!is_current(self, attempt, phase::registering))
              return;
            self->state.instances = rows.instances;
            maybe_register(self);
          },
          give_up(self));
}

// -- opening -----------------------------------------------------------------

void open(self_pointer self, const node_identity& who) {
  auto& st = self->state;
  st.config.identity = who;
  self->request(st.parts.connector, limits::session::open,
                open_session{st.found_address, who})
      .then(
          [self, attempt = st.attempt](const session_opened& reply) {
            if (is_current(self, attempt, phase::opening))
              on_opened(self, reply);
            else
              self->send(reply.session, close_session{"not wanted any more"});
          },
          give_up(self));
}

/// A registration must not be taken for an earlier one of this node, not even
/// after a crash: the epoch is on disk before it is used. Where the disk is
/// full it waits in memory: a node that nobody reaches is worse.
void raise_epoch(self_pointer self) {
  auto& st = self->state;
  auto raised = st.config.identity;
  ++raised.epoch;
  self->request(st.parts.store, limits::local::part,
                store_record{"identity", "node", json(raised).dump(), true})
      .then(
          [self, raised, attempt = st.attempt](const record_stored&) {
            if (is_current(self, attempt, phase::opening))
              open(self, raised);
          },
          give_up(self));
}

void approach(self_pointer self, const coordinator_found& found) {
  auto& st = self->state;
  st.phase = phase::opening;
  st.found_address = found.address;
  raise_epoch(self);
  set_timer(self);
}

/// Announcements linger: one may still be of the coordinator's earlier life.
bool is_older(const membership_status& st, const coordinator_found& found) {
  return found.cell == st.cell && found.coordinator == st.coordinator
         && found.incarnation < st.incarnation;
}

/// An orphan's coordinator may be back at any moment, and its steps wait for
/// it. A search costs some 100 B/s, which is no burden for that time.
std::chrono::milliseconds pause_before_next(membership_status& st) {
  constexpr std::chrono::milliseconds longest_of_orphan{1500};
  const auto pause = st.pause.next();
  return st.state == node_state::orphaned ? std::min(pause, longest_of_orphan)
                                          : pause;
}

} // namespace

void shorten(instance_row& row) {
  row.log_tail.clear();
  if (row.ends.size() > limits::instance::registered_ends)
    row.ends.resize(limits::instance::registered_ends);
  for (auto& end : row.ends)
    end.log.clear();
  row.spec.input.clear();
  row.spec.output.clear();
  row.spec.parameters.clear();
  row.spec.environment.clear();
  row.spec.arguments.clear();
}

bool is_current(self_pointer self, uint64_t attempt, phase where) {
  return self->state.attempt == attempt && self->state.phase == where;
}

void retreat(self_pointer self, const std::string& reason,
             std::chrono::milliseconds pause) {
  auto& st = self->state;
  ++st.attempt;
  st.phase = phase::waiting;
  st.deadline = self->clock().now() + pause;
  st.problem = reason;
  drop_session(self, reason);
  self->send(st.parts.discovery, forget_coordinator{});
  show_presence(self);
  set_timer(self);
}

void on_error(self_pointer self, const caf::error& err) {
  const auto why = to_failure(err);
  if (is_refusal(why.code))
    return attempt_refused(self, why.message, why.hint);
  const auto& st = self->state;
  const bool no_way =
      why.code == error_code::unreachable || why.code == error_code::timeout;
  if (st.phase != phase::opening || !no_way)
    return attempt_failed(self, why.message, why.hint);
  const auto reported = diagnose_session(st.found_address, why.message);
  attempt_failed(self, reported.problem, reported.hint);
}

void try_again(self_pointer self) {
  if (self->state.wanted.empty())
    seek_slot(self);
  else
    begin_attempt(self);
}

void begin_attempt(self_pointer self) {
  auto& st = self->state;
  ++st.attempt;
  st.phase = phase::searching;
  st.deadline = self->clock().now() + limits::membership::search;
  if (st.state == node_state::independent)
    st.state = node_state::joining;
  // Another host may have taken the address, which is why contact was lost.
  if (st.state == node_state::orphaned && st.config.claim_address)
    st.config.claim_address();
  st.older.reset();
  st.opened.reset();
  st.resources.reset();
  st.instances.reset();
  st.registration_sent = false;
  st.unsent.clear();
  st.report.begin(st.wanted, unix_now_ms());
  find_server(self);
  if (st.phase != phase::searching)
    return;
  // Measuring takes a while; it goes on beside the search.
  self->request(st.parts.agent,
                limits::session::resource_query - limits::session::margin,
                resource_query{})
      .then(
          [self, attempt = st.attempt](const resource_report& report) {
            if (self->state.attempt != attempt)
              return;
            self->state.resources = report.resources;
            maybe_register(self);
          },
          give_up(self));
  set_timer(self);
}

void on_found(self_pointer self, const coordinator_found& found) {
  auto& st = self->state;
  if (st.phase == phase::searching) {
    if (is_older(st, found))
      st.older = found;
    else
      approach(self, found);
  } else if (st.phase == phase::joined && found.cell == st.cell
             && found.coordinator == st.coordinator
             && found.incarnation > st.incarnation) {
    on_session_lost(self, "the coordinator has started again");
  }
}

void on_search_over(self_pointer self) {
  auto& st = self->state;
  // Nothing newer is there: the coordinator has lost its records and counts
  // anew. Whether it may have the node is decided by the handshake.
  if (st.older)
    approach(self, *st.older);
  else
    attempt_failed(self, "no coordinator answers at " + st.wanted);
}

void attempt_failed(self_pointer self, const std::string& reason,
                    const std::string& hint) {
  if (give_up_switch(self, reason))
    return;
  // Who has looked around knows better than who has waited in vain.
  if (!std::exchange(self->state.diagnosed, false))
    complain(self, reason, hint);
  // A session that was lost is no attempt.
  if (self->state.phase != phase::joined)
    turn_elsewhere(self, false);
  forget_slot(self);
  retreat(self, reason, pause_before_next(self->state));
}

void attempt_refused(self_pointer self, const std::string& reason,
                     const std::string& hint) {
  auto& st = self->state;
  if (give_up_switch(self, reason))
    return;
  if (st.state == node_state::joining)
    st.state = node_state::independent;
  if (st.report.note(reason, hint, self->clock().now())) {
    json data{{"reason", reason}, {"discovery_server", st.wanted}};
    if (!hint.empty())
      data["hint"] = hint;
    publish_event(self, events::join_refused, std::move(data));
  }
  const bool elsewhere = turn_elsewhere(self, true);
  const bool asked = st.phase == phase::asking;
  forget_slot(self);
  // Who announces himself as a coordinator and refuses, because he is of
  // another site, keeps nobody from asking the next one.
  if (elsewhere)
    retreat(self, reason, pause_before_next(st));
  else if (asked && st.coordinators.slot_arbiter() != nullptr)
    retreat(self, reason, limits::membership::gathering);
  else
    retreat(self, reason, limits::membership::refusal_pause);
}

} // namespace roscell::membership_steps
