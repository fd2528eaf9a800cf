#include "actors/cell/cell_coordinator.hpp"

#include "actors/cell/cell_departures.hpp"
#include "actors/cell/cell_members.hpp"
#include "actors/cell/cell_peers.hpp"
#include "actors/cell/cell_questions.hpp"
#include "actors/cell/cell_slots.hpp"
#include "actors/cell/image_offers.hpp"
#include "actors/cell/moves/abandoned_steps.hpp"
#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/skill_additions.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/streams/stream_watch.hpp"
#include "actors/cell/tasks/cell_instances.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/late_tasks.hpp"
#include "actors/cell/tasks/parameter_changes.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/cell/updates/task_updates.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

cell_description describe(coordinator_pointer self) {
  const auto& st = self->state;
  return {st.setup.cell,          st.setup.self.name,
          st.setup.self.address,  st.setup.discovery_server,
          st.setup.incarnation,   describe_nodes(st),
          describe_all_tasks(st), list_unassigned_nodes(st),
          st.setup.environment};
}

topic_list list_topics(coordinator_pointer self, const topic_query& query) {
  const auto& graph = self->state.setup.graph;
  if (!graph)
    return {};
  return {topic_rows(graph->endpoints(), query.topic)};
}

cell_list cells_seen(const cell_coordinator_state& st) {
  return {list_cells(st)};
}

skill_list list_skills(const cell_coordinator_state& st,
                       const skill_query& query) {
  return {st.registry.skills(query.operation), st.registry.refused_skills(),
          describe_builds(st, query)};
}

void on_status_reported(coordinator_pointer self,
                        const peer_status_reported& event) {
  on_peer_status_reported(self, event);
  grant_awaited_slots(self);
}

/// Whoever it was that has ended.
void on_down(coordinator_pointer self, const caf::actor_addr& gone) {
  on_pipeline_down(self, gone);
  on_member_down(self, gone);
  on_peer_down(self, gone);
}

void serve(coordinator_pointer self, const request_router_actor& router) {
  self->state.router = router;
  wake_for_sets(self);
}

/// A member's user is served like one of this node.
caf::result<request_routed> answer_member(coordinator_pointer self,
                                          const route_request& request) {
  const auto& router = self->state.router;
  if (!router)
    return fail(error_code::conflict, "the coordinator is still starting");
  return self->delegate(router, request);
}

/// It answers as if it had been asked itself.
caf::result<request_routed> relay_to_member(coordinator_pointer self,
                                            const relay_request& request) {
  const auto* entry = self->state.registry.find_name(request.node);
  if (!entry)
    return fail(error_code::unknown_node,
                "this cell has no node '" + request.node + "'", "/node",
                "`roscell nodes` lists them");
  if (!entry->member || !entry->agent)
    return fail(error_code::unreachable, "node '" + request.node + "' is away",
                "/node");
  return self->delegate(entry->member, route_request{request.text, ""});
}

json summary(coordinator_pointer self) {
  const auto& st = self->state;
  return {{"cell", st.setup.cell},
          {"incarnation", st.setup.incarnation},
          {"nodes", describe_nodes(st)},
          {"tasks", describe_all_tasks(st)},
          {"placement_lock", st.pending.placement_lock},
          {"waiting", st.pending.waiting.size()},
          {"cells", list_cells(st)},
          {"unassigned_nodes", list_unassigned_nodes(st)},
          {"slots", st.slots.size()},
          {"transfers", st.transfers.size()},
          {"balancing", st.balancing},
          {"moves", st.moves.size()},
          {"updates", st.updates.size()},
          {"sets", st.sets.size()},
          {"orders", st.orders.size()},
          {"unsafe", st.pending.not_stop_safe.size()},
          {"may_run", st.failures.count(self->clock().now())},
          {"remains", st.pending.remains.size()}};
}

void on_session_admitted(coordinator_pointer self,
                         const session_admitted& event) {
  if (event.role == node_role::coordinator)
    on_peer_admitted(self, event);
  else
    on_member_admitted(self, event);
}

void on_tick(coordinator_pointer self, uint64_t number) {
  if (number != at_once && !self->state.timer.rings(number))
    return;
  settle_overdue_slots(self);
  settle_overdue_transfers(self);
  settle_overdue_arrivals(self);
  open_due_peers(self);
  ask_due_proofs(self);
  retry_due_changes(self);
  ask_overdue_removals(self);
  give_up_late_waits(self);
  end_late_tasks(self);
  start_due_again(self);
  forget_past_remains(self);
  move_abandoned_steps(self);
  go_on_draining(self);
  settle_due_move(self);
  settle_due_updates(self);
  settle_due_sets(self);
  balance_if_due(self);
  write_due_events(self);
  set_timer(self);
}

/// Takes up what the cell was at its coordinator's last end.
void begin(coordinator_pointer self, const actor_context& context,
           const coordinator_setup& setup) {
  self->state.context = context;
  self->state.setup = setup;
  self->state.peers = peer_table{setup.self.uuid};
  add_own_row(self);
  restore_members(self);
  restore_transfers(self);
  restore_tasks(self);
  restore_builds(self);
  restore_places(self, self->state.setup.tasks);
  restore_orders(self);
  self->state.history.restore(self->state.setup.history);
  restore_drains(self);
  restore_sets(self);
  abandon_steps_of_all(self);
  drop_unfinished_tasks(self);
  reconcile_own_node(self);
  measure_own_node(self);
  appear(self);
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_down(self, down.source); });
}

} // namespace

cell_coordinator_actor::behavior_type
cell_coordinator(coordinator_pointer self, const actor_context& context,
                 const coordinator_setup& setup) {
  begin(self, context, setup);
  return {
      [self](const state_query&) { return state_of(summary(self)); },
      [self](const session_admitted& x) { on_session_admitted(self, x); },
      [self](const register_node& x) { return register_member(self, x); },
      [self](const depart_node& x) { return depart_member(self, x); },
      [self](const member_lost& x) { on_member_lost(self, x); },
      [self](const member_skills_changed& x) { on_skills_changed(self, x); },
      [self](const skills_changed& x) { on_own_skills_changed(self, x); },
      [self](const instance_changed& x) { on_instance_changed(self, x); },
      [self](const cell_query&) { return describe(self); },
      [self](const cell_list_query&) { return cells_seen(self->state); },
      [self](const topic_query& x) { return list_topics(self, x); },
      [self](const task_history_query& x) { return report_history(self, x); },
      [self](const task_query& x) { return describe_tasks(self->state, x); },
      [self](const instance_query& x) { return instances_now(self, x); },
      [self](const log_query& x) { return fetch_log(self, x); },
      [self](const kept_logs_query& x) { return collect_kept_logs(self, x); },
      [self](const skill_query& x) { return list_skills(self->state, x); },
      [self](const skill_addition& x) { return add_skill(self, x); },
      [self](const skill_removal& x) { return remove_skill(self, x); },
      [self](const skill_pull& x) { return pull_skill(self, x); },
      [self](const image_request& x) { return offer_image(self, x); },
      [self](const claim_task& x) { return claim_placement_lock(self, x); },
      [self](const collect_resources&) { return answer_resources(self); },
      [self](const collect_metrics&) { return collect_all_metrics(self); },
      [self](const measure_cell&) { return measured(self->state); },
      [self](const record_intent& x) { return hold_placement(self, x); },
      [self](const preempt_instances& x) { return preempt_for_task(self, x); },
      [self](const record_running& x) { return accept_task(self, x); },
      [self](const record_failure& x) { return undo_deployment(self, x); },
      [self](const task_termination& x) { return terminate_task(self, x); },
      [self](const task_restart& x) { return restart_task(self, x); },
      [self](const task_update& x) { return update_task(self, x); },
      [self](const task_revisions_query& x) { return list_revisions(self, x); },
      [self](const task_set_request& x) { return apply_set(self, x); },
      [self](const parameter_change& x) { return change_parameters(self, x); },
      [self](const presence_seen& x) { on_presence_seen(self, x.who); },
      [self](const presence_gone& x) { on_presence_gone(self, x.who); },
      [self](const peer_opened& x) { on_peer_opened(self, x); },
      [self](const peer_lost& x) { on_peer_lost(self, x); },
      [self](const peer_status_reported& x) { on_status_reported(self, x); },
      [self](const peer_changed& x) { on_peer_changed(self, x); },
      [self](const place_request& x) { return grant_slot(self, x); },
      [self](const place_reservation& x) { return reserve_slot(self, x); },
      [self](const member_surrender& x) { return hand_over_members(self, x); },
      [self](const cell_formation& x) { return form_cell(self, x); },
      [self](const node_transfer& x) { return transfer_node(self, x); },
      [self](const node_release& x) { return release_node(self, x); },
      [self](const node_drain& x) { return drain_node(self, x); },
      [self](const node_undrain& x) { return undrain_node(self, x); },
      [self](const cell_rebalance& x) { return rebalance_cell(self, x); },
      [self](const transfer_query& x) { return describe_transfers(self, x); },
      [self](const route_request& x) { return answer_member(self, x); },
      [self](const use_router& x) { serve(self, x.router); },
      [self](const relay_request& x) { return relay_to_member(self, x); },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
