#pragma once

#include <string>
#include <string_view>

namespace roscell {

/// A kind of event. Events are published with one of the kinds below, and with
/// nothing else; docs/events.md has them as a table, which
/// tools/generate_reference.py makes from this list.
struct event_kind {
  std::string_view name;      ///< As on the wire, in logs and in histories.
  std::string_view subject;   ///< Whom it concerns; "-": the node itself.
  std::string_view publisher; ///< Which nodes publish it.
  std::string_view meaning;   ///< What has happened, and what its data say.
};

constexpr bool operator==(std::string_view name, const event_kind& kind) {
  return name == kind.name;
}

constexpr bool operator!=(std::string_view name, const event_kind& kind) {
  return name != kind.name;
}

// Some keep the name on the wire that they have had from the first.
namespace events {

// Nodes.
inline constexpr event_kind node_started{"node_started", "node", "every node",
                                         "It has started."};
inline constexpr event_kind node_stopping{"node_stopping", "node", "every node",
                                          "It ends."};
inline constexpr event_kind runtime_died{
    "runtime_died", "node", "every node",
    "The actor that runs its instances has ended by an error, for the time in "
    "`deaths`."};
inline constexpr event_kind address_changed{
    "address_changed", "node", "every node",
    "Its interface has another address: `interface`, `from` and `to`."};
inline constexpr event_kind address_returned{
    "address_returned", "node", "every node",
    "Its interface has its address again: `address`."};
inline constexpr event_kind identity_renewed{
    "identity_renewed", "UUID", "every node",
    "The node has a new UUID; what it had is `put_aside`."};
inline constexpr event_kind name_label_ignored{
    "name_label_ignored", "node", "every node, at its start",
    "The label `node` that it would give itself is left out, as its operator "
    "has set one of that name: `label` and `reason`."};
inline constexpr event_kind history_failed{
    "history_failed", "-", "every node",
    "The disk takes no events: `message` and `hint`."};
inline constexpr event_kind store_failed{
    "store_failed", "task, instance or none", "every node",
    "A record cannot be written: `reason`, or `message` and `hint`."};
inline constexpr event_kind store_caught_up{
    "store_caught_up", "-", "every node",
    "All that waited for the data directory is written."};
inline constexpr event_kind secret_set{
    "secret_set", "secret", "every node",
    "The node has a value for a secret, in place of another if `replaced`."};
inline constexpr event_kind secret_removed{"secret_removed", "secret",
                                           "every node",
                                           "The node has forgotten a secret."};
inline constexpr event_kind secret_ignored{
    "secret_ignored", "-", "every node, at its start",
    "Something among the files of its secrets is none: `path` and `reason`."};
inline constexpr event_kind certificate_issued{
    "certificate_issued", "node", "a coordinator with identities",
    "It has made a certificate for that node: `serial`, `ends_unix_s`, and "
    "`reason`: invitation or renewal."};
inline constexpr event_kind identity_taken{
    "identity_taken", "node", "every node",
    "The node has a new certificate: `identity`, `ends_unix_s`, and whether it "
    "counts `later` only, after the node's next start."};
inline constexpr event_kind renewal_failed{
    "renewal_failed", "node", "every node",
    "Its certificate was not renewed: `message` and `hint`."};
inline constexpr event_kind revocations_taken{
    "revocations_taken", "-", "every node",
    "The node has a newer list of who counts no more: its `number`, and how "
    "many are `revoked`."};
inline constexpr event_kind record_ignored{
    "record_ignored", "key", "every node, at its start",
    "A record of the data directory cannot be read: `table` and `reason`."};
inline constexpr event_kind configuration_read{
    "configuration_read", "node", "a node that was sent SIGHUP",
    "Its configuration and its skills were read anew: the options that have "
    "`changed`, and those of which that `needs_restart`."};
inline constexpr event_kind configuration_refused{
    "configuration_refused", "node", "a node that was sent SIGHUP",
    "Its configuration cannot be used, and nothing has changed: `reason`, with "
    "the file and the line, and `hint`."};
inline constexpr event_kind edge_problem{
    "edge_trouble", "node", "every node",
    "Something of the host or the network does not work: `message`."};
inline constexpr event_kind measurement_failed{
    "measurement_failed", "node", "every node",
    "The host's resources cannot be measured: `reason`."};

// Requests.
inline constexpr event_kind request_received{
    "request_received", "the task or node that it names",
    "the node that is asked, and the coordinator to which it passes it on",
    "Somebody asks for a change: `request`, `from` and `request_id`."};
inline constexpr event_kind request_refused{
    "request_refused", "type of the message", "the node that is asked",
    "A request has not been carried out."};

// Membership, as the member sees it.
inline constexpr event_kind cell_joined{
    "cell_joined", "the node itself", "member",
    "The node is a member: `cell`, `coordinator`, its `incarnation`, and "
    "`epoch`."};
inline constexpr event_kind cell_left{"cell_left", "the node itself", "member",
                                      "It is none any more: `cell`."};
inline constexpr event_kind coordinator_lost{"coordinator_lost",
                                             "the node itself", "member",
                                             "Its coordinator is away."};
inline constexpr event_kind coordinator_ignored{
    "coordinator_ignored", "the coordinator", "a node that is to join",
    "It speaks another version: `protocol_version` and `reason`."};
inline constexpr event_kind join_refused{
    "join_refused", "the node itself", "a node that is to join",
    "The coordinator has refused it: `code`, `message` and `hint`."};
inline constexpr event_kind join_failed{
    "join_failed", "the node itself", "a node that is to join",
    "The coordinator was not reached: `reason`, `hint` and `attempts`."};
inline constexpr event_kind switch_accepted{
    "switch_accepted", "the node itself", "member",
    "It goes to another cell, before it goes: `transfer`, `cell` and `epoch`."};
inline constexpr event_kind switch_failed{
    "switch_failed", "the node itself", "member",
    "It goes back to its cell: `reason`."};
inline constexpr event_kind event_too_large{
    "fact_too_large", "the node itself", "member",
    "What it has to say does not fit into a frame of its session, so its "
    "coordinator has not heard of it: `fact`, `instance` and `state`."};

// Membership, as the coordinator sees it.
inline constexpr event_kind node_joined{"node_joined", "node", "coordinator",
                                        "The node is a member."};
inline constexpr event_kind node_left{"node_left", "node", "coordinator",
                                      "It is none any more: `reason`."};
inline constexpr event_kind node_lost{
    "node_lost", "node", "coordinator",
    "Its lease has ended, or it was to go elsewhere and is not heard of: "
    "`reason`."};
inline constexpr event_kind node_refused{
    "node_refused", "node", "coordinator",
    "It cannot be a member, as its name or its UUID is another's, or the cell "
    "is full: `uuid`, `address`, `reason` and `hint`."};
inline constexpr event_kind node_renamed{
    "node_renamed", "node", "coordinator",
    "It has another name: `from`, and the tasks that have steps there."};
inline constexpr event_kind node_departing{
    "node_departing", "node", "the coordinator that gives it away",
    "A transfer has begun: `transfer` and its target."};
inline constexpr event_kind transfer_ended{
    "transfer_ended", "node", "the coordinator that gives it away",
    "The transfer is `done` or `returned`: `state`."};
inline constexpr event_kind node_draining{
    "node_draining", "node", "coordinator",
    "All that it runs is to move, and nothing new comes."};
inline constexpr event_kind node_drained{"node_drained", "node", "coordinator",
                                         "Nothing runs there any more."};
inline constexpr event_kind node_undrained{
    "node_undrained", "node", "coordinator", "It gets steps again."};
inline constexpr event_kind node_drain_stuck{
    "node_drain_stuck", "node", "coordinator",
    "Something cannot move; once a `reason`, with what is `left`."};
inline constexpr event_kind address_shared{
    "address_shared", "the node that has registered", "coordinator",
    "Another member has its address: `address`, `with` and `hint`."};
inline constexpr event_kind node_appeared{"node_appeared", "a node in no cell",
                                          "coordinator",
                                          "Its first announcement is seen."};
inline constexpr event_kind node_vanished{"node_vanished", "a node in no cell",
                                          "coordinator",
                                          "It announces itself no more."};
inline constexpr event_kind session_refused{
    "session_refused", "address",
    "coordinator, and every node with an identity",
    "Who called has not proved itself: `code` and `message`."};
inline constexpr event_kind claim_ignored{
    "claim_ignored", "the node that is announced", "coordinator, at its start",
    "It claims the cell's name, or this node's UUID, and does not prove it: "
    "`cell` and `address`."};
inline constexpr event_kind cell_name_conflict{
    "cell_name_conflict", "cell", "every coordinator of a cell of that name",
    "Two cells have one name: the addresses."};

// Other cells.
inline constexpr event_kind peer_joined{
    "peer_joined", "the other cell", "coordinator",
    "The other coordinator has introduced itself: `size`."};
inline constexpr event_kind peer_changed{
    "peer_changed", "the other cell", "coordinator",
    "The other cell has another size: `size`."};
inline constexpr event_kind peer_lost{"peer_lost", "the other cell",
                                      "coordinator", "The session has ended."};
inline constexpr event_kind peer_vanished{
    "peer_vanished", "the other cell", "coordinator",
    "The other coordinator announces itself no more."};
inline constexpr event_kind peer_unreachable{
    "peer_unreachable", "the other cell",
    "the coordinator that is to open the session",
    "No session comes about; once a `reason`."};
inline constexpr event_kind cells_rebalanced{
    "cells_rebalanced", "the cell that gets members",
    "the coordinator that balances cells, the one with the lowest id",
    "Members go to a smaller cell: `members`, their number."};

// Tasks.
inline constexpr event_kind allocation_chosen{
    "allocation_chosen", "task", "coordinator",
    "Its steps have their nodes: `score` and `allocations`."};
inline constexpr event_kind allocation_refused{
    "allocation_refused", "task", "coordinator",
    "A node cannot run a step there any more: `step`, `node`, `deployment` and "
    "`reason`."};
inline constexpr event_kind task_accepted{
    "task_accepted", "task", "coordinator", "It is stored and begins."};
inline constexpr event_kind task_finished{
    "task_finished", "task", "coordinator", "All its steps have ended well."};
inline constexpr event_kind task_failed{
    "task_failed", "task", "coordinator",
    "A step of it has failed: `reason`. A request that was refused before "
    "anything of it was placed is `request_refused` only."};
inline constexpr event_kind task_timed_out{
    "task_timed_out", "task", "coordinator",
    "Its `timeout_s` is over, so these `instances` are ended."};
inline constexpr event_kind task_terminated{
    "task_terminated", "task", "coordinator",
    "It was ended by a request: `instances`, and `pending_nodes`."};
inline constexpr event_kind task_update_begun{
    "task_update_begun", "task", "coordinator",
    "It is being changed: the `revision` that it is to have, and what its "
    "steps do."};
inline constexpr event_kind step_replaced{
    "step_replaced", "task", "coordinator",
    "The new instance of a `step` runs, or the step is no more: `instance`, "
    "`node`, and what it `replaces`."};
inline constexpr event_kind task_updated{
    "task_updated", "task", "coordinator",
    "It is as its new request says, of that `revision`."};
inline constexpr event_kind task_update_reverted{
    "task_update_reverted", "task", "coordinator",
    "Its update has come to nothing: all that was replaced is put back, for "
    "this `reason`."};
inline constexpr event_kind parameters_changed{
    "parameters_changed", "instance", "coordinator",
    "It works with other parameters, without a restart, and its task says so: "
    "`task`, `step`, `node`, what these `parameters` are and the `former` "
    "ones."};
inline constexpr event_kind set_applied{
    "set_applied", "set of tasks", "coordinator",
    "It is to be as a request says: `revision`, `nodes` that it is for, and "
    "how many `changes` that means."};
inline constexpr event_kind set_changed{
    "set_changed", "set of tasks", "coordinator",
    "It is for so many `nodes`, its task is `running` on so many of them as it "
    "is to, and on so many something is `pending`."};
inline constexpr event_kind set_stuck{
    "set_stuck", "set of tasks", "coordinator",
    "Its task on a `node` cannot be made what it is to be, for this `reason`."};
inline constexpr event_kind set_removed{
    "set_removed", "set of tasks", "coordinator",
    "It is no more, and its `tasks` are ended."};
inline constexpr event_kind step_stranded{
    "step_stranded", "instance, the old one", "coordinator",
    "It is to move, or was preempted, and has no place; once a `reason`."};
inline constexpr event_kind rebalance_begun{
    "rebalance_begun", "cell", "coordinator",
    "Steps move to better nodes: the number of moves and both totals."};
inline constexpr event_kind rebalance_ended{
    "rebalance_ended", "cell", "coordinator",
    "The moves that were made, and the `reason` if not all were."};
inline constexpr event_kind reconciliation_failed{
    "reconciliation_failed", "node", "every node",
    "What runs cannot be compared with what is wanted: `reason`."};

// Instances.
inline constexpr event_kind instance_changed{
    "instance_changed", "instance", "its node and the coordinator",
    "It has another `state`: `task`, `step`, and `reason` if there is one."};
inline constexpr event_kind instance_moved{
    "instance_moved", "instance, the new one", "coordinator",
    "It runs where another one did: both nodes, the step and what it "
    "replaces."};
inline constexpr event_kind instance_restarted{
    "instance_restarted", "instance, the new one", "coordinator",
    "It replaces one of a lost node: both nodes, the step and the old one."};
inline constexpr event_kind instance_awaited{
    "instance_awaited", "instance", "its node and the coordinator",
    "It is to go and not stop-safe: the deadline."};
inline constexpr event_kind instance_out_of_reach{
    "instance_out_of_reach", "instance", "coordinator",
    "Its node is lost: `reason`, and what follows."};
inline constexpr event_kind instance_preempted{
    "instance_preempted", "instance", "coordinator",
    "It ends for a task of higher priority: `task`, `step`, `node`, "
    "`priority`, and `by` which task."};
inline constexpr event_kind instance_unwanted{
    "instance_unwanted", "instance", "coordinator",
    "Its node is back and runs it, though its task has gone: its state, and "
    "for how many seconds it has been in that."};
inline constexpr event_kind instance_adopted{
    "instance_adopted", "instance", "its node",
    "It ran on while the node was away."};
inline constexpr event_kind instance_interrupted{
    "instance_interrupted", "instance", "its node",
    "Its host has ended it: `reason`."};
inline constexpr event_kind instance_address_changed{
    "instance_address_changed", "instance", "its node",
    "A skill of the engine was told where its cell is now: `task`, `step`, "
    "`from` and `to`."};
inline constexpr event_kind instance_starved{
    "instance_starved", "instance",
    "its node, also where its discovery server does not know the instance; "
    "the coordinator, where an input gets nothing although its writer sends",
    "An input brings too little: the value, the stream and the step that "
    "writes it."};
inline constexpr event_kind instance_unhealthy{
    "instance_unhealthy", "instance", "its node",
    "An output brings too little: the value and the stream."};
inline constexpr event_kind instance_recovered{
    "instance_recovered", "instance", "its node, or the coordinator",
    "Its streams are as they should be again."};
inline constexpr event_kind exec_begun{
    "exec_begun", "instance", "its node",
    "Somebody runs a command beside it: the `session`, who it comes `from`, "
    "the `program` without its arguments, and whether it has a `terminal`."};
inline constexpr event_kind exec_ended{
    "exec_ended", "instance", "its node",
    "That command has ended: the `session`, its `exit_code`, for how long it "
    "ran in `took_ms`, and where it was ended the `reason`."};
inline constexpr event_kind skill_instance_died{
    "skill_instance_died", "instance", "its node",
    "The actor that supervises it has ended by an error, for the time in "
    "`deaths`."};
inline constexpr event_kind skill_refused{
    "skill_refused", "folder of the skill", "its node",
    "It cannot be used: what is wrong with it."};
inline constexpr event_kind skill_added{
    "skill_added", "operation", "its node and the coordinator",
    "A node has a build of it that it had not: `node`, `hash`, `version`, and "
    "on the node `path`."};
inline constexpr event_kind skill_removed{
    "skill_removed", "operation", "its node and the coordinator",
    "A node has that build no more, as its folder was edited or has gone: "
    "`node`, `hash`, `version`, and on the node `path`. What runs of it goes "
    "on."};
inline constexpr event_kind cell_skill_added{
    "cell_skill_added", "operation", "the coordinator",
    "A build is one of the cell's skills now: `hash`, `version`, `bytes`, and "
    "the `keepers` that never let it go."};
inline constexpr event_kind cell_skill_removed{
    "cell_skill_removed", "operation", "the coordinator",
    "A build is none of the cell's skills any more: `hash` and `version`."};
inline constexpr event_kind build_stored{
    "build_stored", "build", "a node that it has come to",
    "All of a build is here and has been checked: its `bytes`, and the "
    "`cell`."};
inline constexpr event_kind build_fetching{
    "build_fetching", "build", "a node that needs it",
    "How much of it is here: `pieces` of `of`, once a second at most."};
inline constexpr event_kind build_fetched{
    "build_fetched", "build", "a node that needed it",
    "It came from other nodes: its `bytes`, how long it `took_ms`, and how "
    "many `pieces` each source gave."};
inline constexpr event_kind build_source_lost{
    "build_source_lost", "build", "a node that needed it",
    "A `source` is asked no more for this build: the `reason`."};
inline constexpr event_kind skills_not_watched{
    "skills_not_watched", "node", "every node",
    "Not all folders of skills can be watched, so that what changes there is "
    "seen after SIGHUP only; once a `reason`, with a `hint`."};
inline constexpr event_kind fence_failed{
    "fence_failed", "instance", "its node",
    "Its fence cannot be moved on; once, until it can be again: `reason` and "
    "`hint`."};
inline constexpr event_kind cgroup_left{
    "cgroup_left", "instance", "its node",
    "Its cgroup cannot be removed: `folder`."};
inline constexpr event_kind stray_ended{"stray_ended", "instance",
                                        "every node, at its start",
                                        "It ran and nobody knows of it."};
inline constexpr event_kind stray_removal_failed{
    "stray_removal_failed", "instance", "every node, at its start",
    "It runs, nobody knows of it, and it cannot be ended: `reason`."};

// Container engines.
inline constexpr event_kind engine_lost{
    "engine_lost", "socket", "a node with a container engine",
    "The engine does not answer: `message`."};
inline constexpr event_kind engine_found{"engine_found", "socket",
                                         "a node with a container engine",
                                         "The engine answers again."};
inline constexpr event_kind image_building{
    "image_building", "image", "a node with a container engine",
    "A line of the build, once a second at most."};
inline constexpr event_kind image_built{
    "image_built", "image", "a node with a container engine",
    "The image is there: `operation` and `ms`."};
inline constexpr event_kind image_fetched{
    "image_fetched", "image", "a node with a container engine",
    "The engine has got it from that of another `node`: its `image_id` and "
    "`bytes`, and how long it `took_ms`."};
inline constexpr event_kind image_not_fetched{
    "image_not_fetched", "image", "a node with a container engine",
    "No node gives it, so its registry is asked: the `reason`."};
inline constexpr event_kind image_shared{
    "image_shared", "image", "a node with a container engine",
    "The engine has saved it for others: the `build` that it is on its way, "
    "its `bytes`, and how long it `took_ms`."};
inline constexpr event_kind image_pulled{
    "image_pulled", "image", "a node with a container engine",
    "The engine has got it from its `registry`: its `image_id`."};
inline constexpr event_kind image_removed{
    "image_removed", "image", "a node with a container engine",
    "The image of a skill is removed: no container has it, and newer ones "
    "there are as many as are kept."};
inline constexpr event_kind safety_not_asked{
    "safety_not_asked", "instance", "a node with a container engine",
    "A container cannot be asked to become stop-safe: `reason`."};

} // namespace events

} // namespace roscell
