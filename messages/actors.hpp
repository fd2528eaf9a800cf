#pragma once

#include "messages/instance_actors.hpp"

#include <caf/atom.hpp>
#include <caf/replies_to.hpp>
#include <caf/typed_actor.hpp>

/// Every typed handle: the whole protocol inside a node on one page, but for
/// those of instances (messages/instance_actors.hpp). What each message holds
/// stands in the file of its family.
namespace roscell {

/// Gets events as they happen, in the order of their sequence numbers.
using event_listener_actor = caf::typed_actor<caf::reacts_to<event>>;

/// The EVENT LOG: the node's one stream of events.
using event_log_actor = introspected_actor::extend<
    // Gives the event the next sequence number and tells the listeners.
    caf::reacts_to<record_event>,
    // Adds a listener until it ends.
    caf::reacts_to<subscribe_events>,
    caf::replies_to<kept_events_query>::with<kept_events>,
    // From the node's history. Errors: internal (the disk cannot be read).
    caf::replies_to<past_events_query>::with<kept_events>,
    // INTERNAL: what was held back is to be told, or a batch to be written.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The NODE HISTORY: what the node has told in earlier days, on its disk. It
/// blocks there.
using node_history_actor = introspected_actor::extend<
    // Replies once they are on the disk. Errors: internal (no room, the disk
    // cannot be written); nothing of the batch is there then.
    caf::replies_to<event_batch>::with<events_written>,
    // Errors: internal (the disk cannot be read).
    caf::replies_to<past_events_query>::with<kept_events>,
    // From a runtime, which has put it there.
    caf::reacts_to<log_kept>,
    // Errors: unknown_task (no log of that instance is kept).
    caf::replies_to<log_query>::with<log_excerpt>,
    caf::replies_to<kept_logs_query>::with<kept_logs>>;

/// The STATE STORE: the only actor that writes the node's database.
using state_store_actor = introspected_actor::extend<
    // Replies once the record is on disk, or waits for it. Errors: internal
    // (disk full, ...); the disk then holds what it held before.
    caf::replies_to<store_record>::with<record_stored>,
    // The same for several at once.
    caf::replies_to<store_records>::with<record_stored>,
    // INTERNAL: alarm number N is due.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The NODE AGENT: what a coordinator may ask of a node. The local node, a
/// member behind a session and a test's fake all have this handle.
using node_agent_actor = introspected_actor::extend<
    // Errors: timeout, unreachable.
    caf::replies_to<resource_query>::with<resource_report>,
    // Errors: timeout, unreachable. A refusal is no error.
    caf::replies_to<instance_reservation>::with<instances_reserved>,
    // Replies once the instance runs. Errors: as the CONTAINER SUPERVISOR's.
    caf::replies_to<instance_deployment>::with<instance_deployed>,
    // Replies once the named instances are gone from the node, but for those
    // that are not stop-safe yet.
    caf::replies_to<instance_removal>::with<instances_removed>,
    // Replies once its program works with them. Errors: as the SKILL
    // INSTANCE's.
    caf::replies_to<set_parameters>::with<parameters_set>,
    // Errors: timeout, unreachable.
    caf::replies_to<figures_query>::with<figures_report>,
    // Errors: unknown_task.
    caf::replies_to<log_query>::with<log_excerpt>,
    caf::replies_to<kept_logs_query>::with<kept_logs>,
    // Replies once the build is there, whole. Errors: as the BUILD FETCHER's.
    caf::replies_to<build_keeping>::with<build_kept>,
    caf::replies_to<build_release>::with<build_released>,
    // What this node's engine does not know is no error. Errors: engine_failed.
    caf::replies_to<image_query>::with<image_known>,
    // Errors: as the IMAGE EXCHANGE's.
    caf::replies_to<image_sharing>::with<image_shared>>;

/// The node agent of this machine.
using local_agent_actor =
    node_agent_actor::extend<caf::reacts_to<use_settings>,
                             caf::reacts_to<serve_builds>>;

/// The RESOURCE PROBE: answers when asked, at once; it never polls.
using resource_probe_actor = introspected_actor::extend<
    caf::replies_to<measure_host>::with<host_measured>,
    caf::replies_to<measure_use>::with<use_measured>,
    caf::reacts_to<mark_sample>>;

/// Who hears of one session. `frame_received` is sent as a request: the next
/// frames are read once it is answered, which is the back-pressure. All three
/// come from the session itself, so that an owner of several in a row can tell
/// them apart by their sender.
using session_owner_actor = caf::typed_actor<caf::reacts_to<frame_received>,
                                             caf::reacts_to<heartbeat_received>,
                                             caf::reacts_to<session_closed>>;

/// The SESSION: one connection. It ends after `session_closed`.
using session_actor = introspected_actor::extend<
    // Whom to tell; what came before is kept for the owner.
    caf::reacts_to<own_session>, caf::reacts_to<send_frame>,
    caf::reacts_to<send_heartbeat>, caf::reacts_to<close_session>,
    // INTERNAL: from the wire.
    caf::reacts_to<frame_received>, caf::reacts_to<heartbeat_received>,
    caf::reacts_to<session_closed>>;

/// The SESSION CONNECTOR. Errors: unreachable, unauthorized, timeout, conflict.
using session_connector_actor = introspected_actor::extend<
    caf::replies_to<open_session>::with<session_opened>,
    caf::reacts_to<session_settled>>;

/// Who hears of coordinators: the membership.
using discovery_listener_actor =
    caf::typed_actor<caf::reacts_to<coordinator_found>>;

/// Who hears of presences: whoever announces its own.
using presence_listener_actor = caf::typed_actor<caf::reacts_to<presence_seen>,
                                                 caf::reacts_to<presence_gone>>;

/// The DISCOVERY edge of a node: its CLIENT, its own discovery server, and its
/// public participant.
using discovery_actor = introspected_actor::extend<
    // Errors: unreachable (the local address cannot be used).
    caf::replies_to<find_coordinator>::with<caf::ok_atom>,
    // Errors: conflict (the port is in use), unreachable, internal.
    caf::replies_to<serve_programs>::with<programs_served>,
    caf::reacts_to<stop_serving>, caf::reacts_to<forget_coordinator>,
    // Answered when it is done.
    caf::replies_to<follow_server>::with<caf::ok_atom>,
    // What is seen is told to the sender.
    caf::reacts_to<announce_presence>, caf::reacts_to<withdraw_presence>,
    // INTERNAL: alarm number N, to look a peer's name up again.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The JOIN DIAGNOSER: finds out why a cell cannot be joined at an address.
using join_diagnoser_actor = introspected_actor::extend<
    // Errors: unreachable (the name does not resolve), timeout.
    caf::replies_to<resolve_host>::with<host_resolved>,
    // No errors: whatever the ports say is an answer.
    caf::replies_to<probe_server>::with<server_probed>,
    caf::reacts_to<diagnosis_settled>>;

/// The REACH PROBER: tries which packets reach other nodes and come back.
using reach_prober_actor = introspected_actor::extend<
    // Errors: conflict (no port is free), unreachable.
    caf::replies_to<reach_opening>::with<reach_opened>,
    // No errors: whatever the ports say is an answer.
    caf::replies_to<reach_query>::with<reach_report>,
    caf::reacts_to<reach_settled>,
    // INTERNAL: the port has been open for long enough.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The EXAMINER: looks at the node's host once, and ends. Errors: conflict
/// (this program cannot look).
using examiner_actor = introspected_actor::extend<
    caf::replies_to<examination_query>::with<examination>>;

/// The MEMBERSHIP: the node's side of belonging to a cell.
using membership_actor = introspected_actor::extend<
    caf::replies_to<membership_query>::with<membership_state>,
    caf::reacts_to<join_cell>, caf::reacts_to<seek_cell>,
    // Gives out a nonce for a switch.
    caf::replies_to<registration_query>::with<registration_challenge>,
    // From the REST API. Errors: unauthorized (a wrong proof, or a member's
    // registration, which only its coordinator can switch), conflict (another
    // epoch than the present one, or it is switching already).
    caf::replies_to<registration_switch>::with<switch_accepted>,
    // Replies once the coordinator knows, or after a short wait.
    caf::replies_to<leave_cell>::with<node_departed>,
    // A request that a coordinator answers goes to this node's. It always
    // replies, as the REQUEST ROUTER does.
    caf::replies_to<route_request>::with<request_routed>,
    // For this node's engine. Errors: unreachable (in no cell), and those of
    // the coordinator.
    caf::replies_to<image_request>::with<image_offered>,
    // What the coordinator asks the node goes there.
    caf::reacts_to<use_router>, caf::reacts_to<coordinator_found>,
    caf::reacts_to<presence_seen>, caf::reacts_to<presence_gone>,
    caf::reacts_to<instance_changed>, caf::reacts_to<skills_changed>,
    caf::reacts_to<frame_received>, caf::reacts_to<heartbeat_received>,
    caf::reacts_to<session_closed>,
    // INTERNAL: a timer of attempt or lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The MEMBER: the coordinator's view of one remote node. A node agent that
/// speaks over a session, and the lease of that session. It ends with it.
using member_actor = node_agent_actor::extend<
    // Errors: those of the node; unreachable and timeout leave it open whether
    // the node has gone.
    caf::replies_to<registration_switch>::with<switch_accepted>,
    // A request that the node answers itself. Errors: unreachable, timeout, and
    // those of the node.
    caf::replies_to<route_request>::with<request_routed>,
    caf::reacts_to<frame_received>, caf::reacts_to<heartbeat_received>,
    caf::reacts_to<session_closed>,
    // Ends the session, telling the node why.
    caf::reacts_to<close_session>,
    // INTERNAL: a timer of lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The PEER: a coordinator's view of another one. The questions are those that
/// a coordinator answers itself; it asks them over the session. It ends with
/// the session, telling the coordinator `peer_lost`.
using peer_actor = introspected_actor::extend<
    // Errors: those of the other coordinator; unreachable, timeout.
    caf::replies_to<place_request>::with<place_granted>,
    caf::replies_to<place_reservation>::with<place_reserved>,
    caf::replies_to<member_surrender>::with<members_surrendered>,
    caf::replies_to<node_transfer>::with<node_transferred>,
    caf::replies_to<node_release>::with<node_released>,
    // To be told to the other coordinator; the status comes first.
    caf::reacts_to<cell_standing>, caf::reacts_to<cell_changed>,
    caf::reacts_to<frame_received>, caf::reacts_to<heartbeat_received>,
    caf::reacts_to<session_closed>,
    // Ends the session, telling the other coordinator why.
    caf::reacts_to<close_session>,
    // INTERNAL: a timer of lease number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The REGISTRATION CLIENT. Errors: unreachable, timeout, and those of the
/// node.
using registration_client_actor = introspected_actor::extend<
    caf::replies_to<switch_node>::with<switch_accepted>,
    // Errors: unauthorized too, where there is no proof.
    caf::replies_to<prove_status>::with<status_proved>,
    caf::reacts_to<node_answered>>;

/// The SCHEDULER. Errors: no_feasible_allocation, conflict (a node has left in
/// the middle of the search).
using scheduler_actor = introspected_actor::extend<
    caf::replies_to<allocate_task>::with<task_plan>,
    caf::replies_to<plan_moves>::with<moves_planned>>;

/// The CELL COORDINATOR: owns the cell registry and the tasks.
using cell_coordinator_actor = introspected_actor::extend<
    // A node has authenticated itself; a MEMBER is made for it.
    caf::reacts_to<session_admitted>,
    // Errors: conflict (the name belongs to another UUID, an old epoch).
    caf::replies_to<register_node>::with<node_registered>,
    caf::replies_to<depart_node>::with<node_departed>,
    caf::reacts_to<member_lost>, caf::reacts_to<member_skills_changed>,
    // Of its own node.
    caf::reacts_to<skills_changed>,
    // From a member or the local supervisor.
    caf::reacts_to<instance_changed>,
    caf::replies_to<cell_query>::with<cell_description>,
    caf::replies_to<cell_list_query>::with<cell_list>,
    caf::replies_to<topic_query>::with<topic_list>,
    // Errors of the queries: unknown_task.
    caf::replies_to<task_history_query>::with<task_history>,
    caf::replies_to<task_query>::with<task_description>,
    caf::replies_to<instance_query>::with<instance_description>,
    caf::replies_to<log_query>::with<log_excerpt>,
    // Replies once each node has told, or is not waited for any longer.
    caf::replies_to<kept_logs_query>::with<kept_logs>,
    caf::replies_to<skill_query>::with<skill_list>,
    // Replies once a second node has it and the store has kept it. Errors:
    // unknown_node, conflict (another build of that version and architecture,
    // too many builds), schema_violation (it is no skill), unreachable,
    // internal.
    caf::replies_to<skill_addition>::with<skill_added>,
    // Errors: unknown_operation, conflict (it runs, or is on its way),
    // internal.
    caf::replies_to<skill_removal>::with<skill_removed>,
    // Replies once the node has it. Errors: unknown_operation, unknown_node,
    // conflict (the node fetches no builds), unreachable, internal.
    caf::replies_to<skill_pull>::with<skill_pulled>,
    // Replies once a node has made a build of the image. Errors: unknown_node,
    // conflict (no node's engine knows it), and those of the nodes.
    caf::replies_to<image_request>::with<image_offered>,
    // Waits while the same request is being deployed. The task is the sender's
    // until all of it runs or the sender ends. Errors: task_exists, conflict.
    caf::replies_to<claim_task>::with<task_claimed>,
    caf::replies_to<collect_resources>::with<cell_resources>,
    // Replies once each node has told, or is not waited for any longer.
    caf::replies_to<collect_metrics>::with<metrics_collected>,
    caf::replies_to<measure_cell>::with<cell_measured>,
    // Replies once the store has kept it. Errors: conflict (a member has gone
    // meanwhile), internal (the store cannot keep it).
    caf::replies_to<record_intent>::with<intent_recorded>,
    // Replies once what stood in the task's way is gone. Errors: unknown_task
    // (it was terminated meanwhile).
    caf::replies_to<preempt_instances>::with<instances_preempted>,
    // Replies once the store has kept it; what it cannot keep is rolled back.
    caf::replies_to<record_running>::with<task_accepted>,
    // Replies once what was started is gone.
    caf::replies_to<record_failure>::with<task_rolled_back>,
    // Replies once the store has kept it. Errors: unknown_task, internal.
    caf::replies_to<task_termination>::with<task_terminated>,
    // Replies once what was ended runs again. Errors: unknown_task, conflict
    // (it is being deployed, ended or moved), no_feasible_allocation, internal;
    // engine_failed and others where an instance does not come up.
    caf::replies_to<task_restart>::with<task_restarted>,
    // Replies once it is known what is changed, and written down. Errors:
    // unknown_task, conflict (it is being deployed, ended, moved or updated),
    // no_feasible_allocation, internal, and those of reading a request.
    caf::replies_to<task_update>::with<task_update_plan>,
    // Errors: unknown_task.
    caf::replies_to<task_revisions_query>::with<task_revisions>,
    // Replies once the set is written down. Errors: conflict (a task has that
    // name, too many sets), schema_violation (a name that would be too long),
    // task_exists (another request, where only a new set is wanted), internal.
    caf::replies_to<task_set_request>::with<task_set_plan>,
    // Replies once the program works with them and the task says so. Errors:
    // unknown_task, schema_violation (no such parameter, one that cannot be
    // changed, a value that it cannot have), conflict (it does not run, or its
    // program refuses), unreachable, timeout, internal.
    caf::replies_to<parameter_change>::with<parameters_changed>,
    caf::reacts_to<presence_seen>, caf::reacts_to<presence_gone>,
    caf::reacts_to<peer_opened>, caf::reacts_to<peer_lost>,
    caf::reacts_to<peer_status_reported>, caf::reacts_to<peer_changed>,
    // Errors: unreachable (the coordinator that hands out places is silent).
    caf::replies_to<place_request>::with<place_granted>,
    // Errors: conflict (the name belongs to another node).
    caf::replies_to<place_reservation>::with<place_reserved>,
    // Errors: unknown_cell, conflict (this cell does not take part in
    // balancing).
    caf::replies_to<member_surrender>::with<members_surrendered>,
    // One outcome a name; no errors.
    caf::replies_to<cell_formation>::with<cell_formed>,
    // Errors: unknown_node, unknown_cell, conflict (a coordination node, the
    // node's own cell, instances, already switching), unreachable, unresolved,
    // no_feasible_allocation.
    caf::replies_to<node_transfer>::with<node_transferred>,
    caf::replies_to<node_release>::with<node_released>,
    // Errors: unknown_node, internal (the store cannot keep it).
    caf::replies_to<node_drain>::with<node_drained>,
    caf::replies_to<node_undrain>::with<node_undrained>,
    // Errors: conflict (other moves are being made).
    caf::replies_to<cell_rebalance>::with<cell_rebalanced>,
    // Errors: unknown_task.
    caf::replies_to<transfer_query>::with<transfer_description>,
    // From a member, whose user has asked it.
    caf::replies_to<route_request>::with<request_routed>,
    caf::reacts_to<use_router>,
    // Has a member answer. Errors: unknown_node, unreachable, timeout, and
    // those of the member.
    caf::replies_to<relay_request>::with<request_routed>,
    // INTERNAL: timer number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The REQUEST ROUTER: message type to pipeline, else handler, else rejection.
/// It always replies; what goes wrong is in the reply's text.
using request_router_actor = introspected_actor::extend<
    caf::replies_to<route_request>::with<request_routed>>;

/// A HANDLER PIPELINE: one request on its way through a chain of handlers. It
/// ends with its request. Errors: those of its handlers.
using handler_pipeline_actor = introspected_actor::extend<
    caf::replies_to<process_request>::with<request_processed>>;

/// A TASK CHANGE WAITER: waits for one query, and ends with its answer.
using task_change_waiter_actor = introspected_actor::extend<
    caf::reacts_to<event>,
    // Errors: those of the coordinator.
    caf::replies_to<task_change_query>::with<task_change>,
    // INTERNAL: alarm number N is due.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The SITE KEEPER: what this node is at its site, and on a coordinator who may
/// become something there. It blocks on the disk.
using site_keeper_actor = introspected_actor::extend<
    caf::replies_to<site_query>::with<site_status>,
    // Errors: conflict (this node has no identity that can let others in, too
    // many invitations).
    caf::replies_to<site_invitation>::with<site_invited>,
    // Errors: unauthorized (no such invitation, used, over, no proof, another
    // name), schema_violation (the request), internal (the disk).
    caf::replies_to<site_entry>::with<site_entered>,
    // Errors: unauthorized (he may not, he was revoked), schema_violation.
    caf::replies_to<site_renewal>::with<site_entered>,
    caf::replies_to<identity_request_query>::with<identity_requested>,
    // Errors: schema_violation (not of the keys that this node has asked with),
    // conflict (it is of another site), internal (the disk).
    caf::replies_to<identity_setting>::with<identity_set>,
    // Errors: conflict (this node has no identity), schema_violation (not the
    // site's).
    caf::replies_to<revocation_setting>::with<revocations_set>,
    caf::reacts_to<note_coordinator>,
    // INTERNAL: a coordinator has answered.
    caf::reacts_to<renewal_answered>,
    // INTERNAL: it may be time to ask for a fresh certificate.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The AUDIT LOG: who has changed what, on the disk. It blocks there.
using audit_log_actor =
    introspected_actor::extend<caf::replies_to<audit_query>::with<audit_list>,
                               caf::reacts_to<note_change>>;

/// The NODE: root of everything that runs on one machine.
using node_actor = introspected_actor::extend<
    caf::replies_to<node_query>::with<node_description>,
    // What unauthenticated peers may know.
    caf::replies_to<hello_query>::with<node_hello>,
    caf::reacts_to<use_settings>, caf::reacts_to<stop_node>>;

} // namespace roscell
