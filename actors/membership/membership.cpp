#include "actors/membership/membership.hpp"

#include "actors/membership/membership_steps.hpp"
#include "actors/session/limits.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace roscell {

namespace membership_steps {

using phase = membership_phase;

void set_timer(self_pointer self) {
  auto& st = self->state;
  auto when = st.next();
  if (st.phase == phase::waiting || st.phase == phase::searching)
    when = std::min(when, st.deadline);
  if (is_looking(st))
    when = std::min(when, st.look_due);
  if (when != membership_status::time_point::max())
    st.timer.set(self, when);
}

void publish_event(self_pointer self, const event_kind& what, json data) {
  const auto& st = self->state;
  st.context.publish_event(what, st.config.identity.name, data);
}

void finish_leaving(self_pointer self) {
  auto& st = self->state;
  ++st.attempt;
  st.phase = phase::resting;
  drop_session(self, "it leaves the cell");
  self->send(st.parts.discovery, forget_coordinator{});
  st.state = node_state::independent;
  st.switching.reset();
  if (auto cell = std::exchange(st.cell, {}); !cell.empty())
    publish_event(self, events::cell_left, {{"cell", cell}});
  stop_programs(self);
  st.cell_uuid.clear();
  st.coordinator.clear();
  st.address.clear();
  st.incarnation = 0;
  st.problem.clear();
  st.report.clear();
  st.pause.reset();
  for (auto& leaver : std::exchange(st.leavers, {}))
    leaver.deliver(node_departed{});
  if (!st.wanted.empty())
    begin_attempt(self);
  else
    withdraw_presence_now(self);
}

} // namespace membership_steps

namespace {

using namespace membership_steps;

/// The coordinator may show the row before this node has been told.
bool may_have_row(const membership_status& st) {
  return st.phase == phase::joined
         || (st.phase == phase::registering && st.registration_sent);
}

/// Tells the coordinator, if there is one, and then leaves.
void leave(self_pointer self, const std::string& reason) {
  auto& st = self->state;
  if (st.phase == phase::leaving)
    return;
  if (!may_have_row(st))
    return finish_leaving(self);
  st.phase = phase::leaving;
  st.frames.call(message_json(node_departure{reason}),
                 self->clock().now() + limits::membership::departure,
                 [self](const caf::expected<json>&) {
                   if (self->state.phase == phase::leaving)
                     finish_leaving(self);
                 });
  set_timer(self);
}

caf::result<node_departed> on_leave(self_pointer self,
                                    const leave_cell& request) {
  auto promise = self->make_response_promise<node_departed>();
  self->state.leavers.push_back(promise);
  self->state.wanted.clear();
  self->state.seeking = false;
  leave(self, request.reason);
  return promise;
}

void on_join(self_pointer self, const join_cell& request) {
  auto& st = self->state;
  const bool same = st.wanted == request.discovery_server;
  st.wanted = request.discovery_server;
  if (!same)
    st.origin = join_origin::given;
  if (st.phase == phase::leaving)
    return; // Done once it has left.
  if (st.phase == phase::resting || (same && st.phase == phase::waiting)) {
    st.pause.reset();
    begin_attempt(self);
  } else if (!same) {
    leave(self, "it goes to another cell");
  }
}

void on_seek(self_pointer self) {
  auto& st = self->state;
  st.seeking = true;
  if (st.phase == phase::resting)
    seek_slot(self);
}

/// Takes up what an earlier run has stored, if the node is started as then.
void resume(self_pointer self) {
  auto& st = self->state;
  st.stored = st.config.restored;
  if (!takes_up_earlier_cell(st.config)) {
    publish_environment(self);
    if (st.config.configured == "wait")
      show_presence(self);
    return;
  }
  if (st.stored->discovery_server.empty()) {
    publish_environment(self);
    return show_presence(self);
  }
  st.wanted = st.stored->discovery_server;
  st.origin = st.stored->origin;
  st.cell = st.stored->cell;
  st.cell_uuid = st.stored->cell_uuid;
  st.state = node_state::orphaned;
  resume_programs(self);
  begin_attempt(self);
}

void on_instance_changed(self_pointer self, const instance_changed& event) {
  auto& st = self->state;
  // A registration carries all that was before it.
  if (st.phase == phase::joined || st.phase == phase::leaving)
    notify(self, event);
  else if (st.phase == phase::registering && st.instances)
    st.unsent[event.instance.spec.instance] = event;
}

/// They are part of the next registration, and one that is under way is told
/// of them once it is answered.
void on_skills_changed(self_pointer self, const skills_changed& now) {
  auto& st = self->state;
  st.config.skills = now.skills;
  st.config.refused_skills = now.refused_skills;
  if (st.phase == phase::joined || st.phase == phase::leaving)
    notify_skills(self);
  else
    st.skills_unsent = true;
}

void on_tick(self_pointer self, uint64_t number) {
  auto& st = self->state;
  if (!st.timer.rings(number))
    return;
  const auto now = self->clock().now();
  if (st.phase == phase::waiting && now >= st.deadline)
    try_again(self);
  else if (st.phase == phase::searching && now >= st.deadline)
    on_search_over(self);
  else if (is_looking(st) && now >= st.look_due)
    seek_coordinators(self);
  st.frames.calls().expire(now);
  if (!keep_lease(self))
    on_session_lost(self, missed_heartbeats_text());
  seek_coordinator(self);
  set_timer(self);
}

actor_state describe(const membership_status& st) {
  return state_of({{"state", st.state},
                   {"phase", st.phase},
                   {"wanted", st.wanted},
                   {"origin", st.origin},
                   {"seeking", st.seeking},
                   {"visible_coordinators", st.coordinators.size()},
                   {"cell", st.cell},
                   {"coordinator", st.coordinator},
                   {"address", st.address},
                   {"incarnation", st.incarnation},
                   {"epoch", st.config.identity.epoch},
                   {"attempt", st.attempt},
                   {"trouble", st.problem},
                   {"pending_calls", st.frames.calls().pending()}});
}

membership_state answer(const membership_status& st) {
  const bool member = st.state == node_state::member;
  return {st.config.identity,
          st.state,
          st.cell,
          st.address,
          st.wanted,
          member ? std::vector<join_failure>{} : st.report.rows(),
          program_environment(st)};
}

} // namespace

bool takes_up_earlier_cell(const membership_config& config) {
  return config.restored && config.restored->configured == config.configured;
}

membership_actor::behavior_type membership(self_pointer self,
                                           actor_context context,
                                           membership_parts parts,
                                           membership_config config) {
  auto& st = self->state;
  st.pause = backoff{
      static_cast<uint32_t>(std::hash<std::string>{}(config.identity.uuid))};
  st.context = std::move(context);
  st.parts = std::move(parts);
  st.config = std::move(config);
  self->set_down_handler([self](const caf::down_msg& down) {
    if (self->state.session && down.source == self->state.session)
      on_session_lost(self, "the session has failed");
  });
  resume(self);
  return {
      [self](const state_query&) { return describe(self->state); },
      [self](const membership_query&) { return answer(self->state); },
      [self](const join_cell& request) { on_join(self, request); },
      [self](const seek_cell&) { on_seek(self); },
      [self](const registration_query& x) { return make_challenge(self, x); },
      [self](const registration_switch& order) {
        auto promise = self->make_response_promise<switch_accepted>();
        on_proven_switch(self, order,
                         [promise](caf::expected<switch_accepted> x) mutable {
                           if (x)
                             promise.deliver(*x);
                           else
                             promise.deliver(x.error());
                         });
        return promise;
      },
      [self](const leave_cell& request) { return on_leave(self, request); },
      [self](const route_request& x) { return pass_on(self, x); },
      [self](const image_request& x) { return ask_for_image(self, x); },
      [self](const use_router& x) { self->state.router = x.router; },
      [self](const coordinator_found& found) { on_found(self, found); },
      [self](const presence_seen& x) { on_presence_seen(self, x.who); },
      [self](const presence_gone& x) { on_presence_gone(self, x.who); },
      [self](const instance_changed& event) {
        on_instance_changed(self, event);
      },
      [self](const skills_changed& now) { on_skills_changed(self, now); },
      [self](const frame_received& frame) {
        if (is_from_session(self))
          on_frame(self, frame);
      },
      [self](const heartbeat_received& heartbeat) {
        if (is_from_session(self))
          on_heartbeat(self, heartbeat);
      },
      [self](const session_closed& event) {
        if (is_from_session(self))
          on_session_lost(self, event.reason);
      },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
