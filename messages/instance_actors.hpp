#pragma once

#include "messages/forward.hpp"

#include <caf/atom.hpp>
#include <caf/replies_to.hpp>
#include <caf/typed_actor.hpp>

/// The typed handles of what runs a node's instances: the runtimes, each skill
/// instance, and the container supervisor that owns them.
namespace roscell {

/// The clause that every typed handle includes.
using introspected_actor =
    caf::typed_actor<caf::replies_to<state_query>::with<actor_state>>;

/// Who hears of exits and notifications: the container supervisor.
using container_listener_actor =
    caf::typed_actor<caf::reacts_to<container_exited>,
                     caf::reacts_to<instance_notified>,
                     caf::reacts_to<runtime_problem_changed>>;

/// The RUNTIME: the only actor that starts and stops programs.
using runtime_actor = introspected_actor::extend<
    // Errors: engine_failed (missing or not executable entry point, failed
    // build: details "log_tail").
    caf::replies_to<prepare_image>::with<image_prepared>,
    // Errors: engine_failed.
    caf::replies_to<start_container>::with<container_started>,
    // Neither fails for a container that is gone already. Errors:
    // engine_failed (it cannot be killed, its files cannot be removed).
    caf::replies_to<stop_container>::with<container_stopped>,
    caf::replies_to<remove_container>::with<container_removed>,
    caf::replies_to<adopt_container>::with<container_adopted>,
    caf::reacts_to<hear_container>, caf::reacts_to<fence_container>,
    caf::reacts_to<ask_for_safety>,
    // Errors: unknown_task (no log of that instance), conflict (too many
    // wait for more).
    caf::replies_to<log_query>::with<log_excerpt>>;

/// The PROCESS RUNTIME: runs skills as supervised processes.
using process_runtime_actor =
    runtime_actor::extend<caf::reacts_to<program_ended>,
                          caf::reacts_to<log_grown>,
                          // INTERNAL: alarm number N is due.
                          caf::reacts_to<caf::tick_atom, uint64_t>>;

/// Who gets images from other nodes: the membership, or the coordinator.
using image_broker_actor =
    caf::typed_actor<caf::replies_to<image_request>::with<image_offered>>;

/// The IMAGE EXCHANGE: container images that this node's engine gets from those
/// of other nodes, or gives to them.
using image_exchange_actor = introspected_actor::extend<
    // Replies once the engine has it. Errors: conflict (the node is in no cell,
    // or no node has it), unreachable (no source gives it), schema_violation
    // (what has come is another image), engine_failed (it cannot be loaded).
    caf::replies_to<bring_image>::with<image_brought>,
    // Errors: engine_failed.
    caf::replies_to<image_query>::with<image_known>,
    // Errors: conflict (there is no room for it), engine_failed (it cannot be
    // saved), internal (the disk).
    caf::replies_to<image_sharing>::with<image_shared>,
    caf::reacts_to<serve_images>>;

/// The IMAGE WORKER: asks the engine about one image, and waits for it.
using image_worker_actor = introspected_actor::extend<
    // Errors: engine_failed.
    caf::replies_to<image_query>::with<image_known>,
    caf::replies_to<list_layers>::with<layers_listed>,
    // Errors: conflict (it is too large), engine_failed, internal (the disk).
    caf::replies_to<save_image>::with<image_saved>,
    // Errors: schema_violation (it is another image), engine_failed, internal.
    caf::replies_to<load_image>::with<image_loaded>>;

/// The IMAGE PACKER: looks into one skill folder and packs it.
using image_packer_actor = introspected_actor::extend<
    // Errors: engine_failed (missing or not executable entry point, a library
    // that this host has not).
    caf::replies_to<prepare_image>::with<image_planned>,
    // Errors: engine_failed (the disk is full), conflict (nothing is planned).
    caf::replies_to<pack_image>::with<image_packed>,
    // How this host's user logs in to a registry. Errors: unauthorized (the
    // file of logins or a helper cannot be used).
    caf::replies_to<find_login>::with<login_found>>;

/// The ENGINE RUNTIME: runs skills as containers of Docker or Podman.
using engine_runtime_actor =
    runtime_actor::extend<caf::reacts_to<engine_answered>,
                          caf::reacts_to<engine_streamed>,
                          caf::reacts_to<engine_log_read>,
                          // INTERNAL: alarm number N is due.
                          caf::reacts_to<caf::tick_atom, uint64_t>>;

/// Told of the endpoints of one program: its skill instance.
using endpoint_listener_actor =
    caf::typed_actor<caf::reacts_to<endpoints_missing>>;

/// The GRAPH WATCH: what the node's discovery server knows of the programs on
/// this node.
using graph_watch_actor = introspected_actor::extend<
    // What is missing is told to the sender.
    caf::reacts_to<watch_endpoints>, caf::reacts_to<graph_changed>>;

/// The SKILL INSTANCE: one instance's life, a state machine around a container.
/// All that comes of it is told to the supervisor as `instance_changed`; the
/// actor ends with its instance.
using skill_instance_actor = introspected_actor::extend<
    caf::reacts_to<start_instance>, caf::reacts_to<stop_instance>,
    caf::reacts_to<container_exited>, caf::reacts_to<instance_notified>,
    caf::reacts_to<endpoints_missing>, caf::reacts_to<contact_proven>,
    caf::reacts_to<contact_lost>, caf::reacts_to<use_environment>,
    // Replies once its program works with them. Errors: conflict (it does not
    // run, its program is told something else already, does not take
    // parameters while it runs, or refuses these), timeout.
    caf::replies_to<set_parameters>::with<parameters_set>,
    // INTERNAL: a deadline of phase number N has passed.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// Told of every change of an instance: the membership, or the coordinator.
using instance_listener_actor =
    caf::typed_actor<caf::reacts_to<instance_changed>>;

/// Told of the node's skills when they are others: the membership, or the
/// coordinator.
using skill_listener_actor = caf::typed_actor<caf::reacts_to<skills_changed>>;

/// The SKILL WATCHER: keeps what the node knows of its skills as it lies in
/// their folders. It blocks on the disk.
using skill_watcher_actor =
    introspected_actor::extend<caf::reacts_to<skill_folders_touched>,
                               caf::replies_to<read_skills>::with<skills_read>,
                               // Other folders, which are read at once.
                               caf::reacts_to<use_settings>,
                               // INTERNAL: alarm number N is due.
                               caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The CONTAINER SUPERVISOR: owns every skill instance of the node.
using container_supervisor_actor = introspected_actor::extend<
    // Replies once the instance runs; the same spec again gets the same answer.
    // Errors: unknown_operation (no such skill here), unknown_model,
    // unknown_deployment, engine_failed (with details "instance", "node",
    // "exit_code", "log_tail"), conflict (the id is in use by another spec, the
    // node is full, the instance is being removed), schema_violation (the id
    // cannot be a file name).
    caf::replies_to<instance_deployment>::with<instance_deployed>,
    // Replies once they are gone, but for those that are not stop-safe yet;
    // none is no error. Errors: engine_failed (one cannot be removed).
    caf::replies_to<instance_removal>::with<instances_removed>,
    // Errors: unknown_task (no such instance), and those of the instance.
    caf::replies_to<set_parameters>::with<parameters_set>,
    // Errors: unknown_task (no such instance).
    caf::replies_to<instance_query>::with<instance_description>,
    // The same. Where the instance is gone its kept log is read.
    caf::replies_to<log_query>::with<log_excerpt>,
    caf::replies_to<kept_logs_query>::with<kept_logs>,
    caf::reacts_to<listen_to_instances>, caf::reacts_to<ends_acknowledged>,
    caf::reacts_to<use_environment>, caf::reacts_to<contact_proven>,
    caf::reacts_to<contact_lost>, caf::reacts_to<container_exited>,
    caf::reacts_to<instance_notified>, caf::reacts_to<runtime_problem_changed>,
    // Who carries out what a program wishes.
    caf::reacts_to<use_router>,
    // INTERNAL: from a skill instance.
    caf::reacts_to<instance_changed>>;

/// The EXEC HOST: commands of operators beside the instances of this node.
using exec_host_actor = introspected_actor::extend<
    // Replies once it runs. Errors: unknown_task (no such instance), conflict
    // (it does not run, or is an actor; too many commands at once),
    // schema_violation (the command is too long), engine_failed (it cannot be
    // started).
    caf::replies_to<exec_request>::with<exec_started>,
    // Errors of both: unknown_task (no such command: it has ended), conflict
    // (another offset than the one that comes next).
    caf::replies_to<exec_input>::with<exec_input_taken>,
    caf::replies_to<exec_output_query>::with<exec_output>,
    caf::reacts_to<exec_progress>,
    // INTERNAL: alarm number N is due.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The SECRET KEEPER: the secrets of this node. It blocks on the disk.
using secret_keeper_actor = introspected_actor::extend<
    // Replies once it is on the disk. Errors: schema_violation (no base64, too
    // long), conflict (too many secrets), internal (the disk).
    caf::replies_to<secret_setting>::with<secret_set>,
    caf::replies_to<secret_query>::with<secret_list>,
    // Errors: conflict (there is none of that name), internal.
    caf::replies_to<secret_removal>::with<secret_removed>,
    // Errors: conflict (there is none of that name), internal (no room, no
    // file system of memory).
    caf::replies_to<lay_out_secrets>::with<secrets_laid_out>,
    caf::reacts_to<clear_secrets>>;

/// The BUILD KEEPER: the builds on this node's disk. It blocks there.
using build_keeper_actor = introspected_actor::extend<
    // Nothing happens to one that is here. Errors: schema_violation (the
    // manifest), conflict (what is in use leaves too little room), internal
    // (the disk).
    caf::replies_to<offer_build>::with<build_held>,
    // Errors: schema_violation (other bytes than that piece's), conflict (no
    // such build is here, or it is another one), internal.
    caf::replies_to<store_piece>::with<build_held>,
    // Errors: conflict (it is not here; too many wait for more of one).
    caf::replies_to<build_query>::with<build_held>,
    caf::replies_to<piece_query>::with<piece_read>,
    caf::replies_to<pin_build>::with<build_held>,
    // Errors: conflict too (it is for other architectures).
    caf::replies_to<use_build>::with<build_held>,
    // Errors: schema_violation too (it is no skill).
    caf::replies_to<describe_build>::with<build_described>,
    // Errors: as for `offer_build`.
    caf::replies_to<take_build>::with<build_held>,
    // Errors: conflict (it is in use), internal.
    caf::replies_to<drop_build>::with<build_dropped>,
    caf::reacts_to<belong_to_cell>>;

/// The BUILD FETCHER: gets builds from other nodes of the cell.
using build_fetcher_actor = introspected_actor::extend<
    // Replies once the build is here, whole and checked. Errors: unreachable
    // (no source gives it, or those that do lie), and those of the keeper.
    caf::replies_to<fetch_build>::with<build_fetched>,
    caf::reacts_to<source_answered>,
    // A timer is due.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

} // namespace roscell
