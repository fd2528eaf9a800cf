#pragma once

#include "messages/actors.hpp"

#include <caf/type_id.hpp>

/// Every type that travels in a message. A type that is missing here does not
/// compile in a message (CAF_ENABLE_TYPE_ID_CHECKS).
#define ROSCELL_MESSAGE_STRUCTS(X)                                             \
  X(skill_query)                                                               \
  X(skill_list)                                                                \
  X(instance_query)                                                            \
  X(instance_description)                                                      \
  X(log_query)                                                                 \
  X(log_excerpt)                                                               \
  X(kept_logs_query)                                                           \
  X(kept_logs)                                                                 \
  X(log_kept)                                                                  \
  X(node_query)                                                                \
  X(node_description)                                                          \
  X(hello_query)                                                               \
  X(node_hello)                                                                \
  X(task_termination)                                                          \
  X(task_terminated)                                                           \
  X(task_restart)                                                              \
  X(task_restarted)                                                            \
  X(task_history_query)                                                        \
  X(task_history)                                                              \
  X(task_query)                                                                \
  X(task_description)                                                          \
  X(task_change_query)                                                         \
  X(task_change)                                                               \
  X(task_accepted)                                                             \
  X(task_plan)                                                                 \
  X(cell_query)                                                                \
  X(cell_description)                                                          \
  X(cell_list_query)                                                           \
  X(cell_list)                                                                 \
  X(topic_query)                                                               \
  X(topic_list)                                                                \
  X(cell_formation)                                                            \
  X(cell_formed)                                                               \
  X(node_release)                                                              \
  X(node_released)                                                             \
  X(node_drain)                                                                \
  X(node_drained)                                                              \
  X(node_undrain)                                                              \
  X(node_undrained)                                                            \
  X(cell_rebalance)                                                            \
  X(cell_rebalanced)                                                           \
  X(node_transfer)                                                             \
  X(node_transferred)                                                          \
  X(transfer_query)                                                            \
  X(transfer_description)                                                      \
  X(cell_standing)                                                             \
  X(cell_changed)                                                              \
  X(place_request)                                                             \
  X(place_granted)                                                             \
  X(place_reservation)                                                         \
  X(place_reserved)                                                            \
  X(member_surrender)                                                          \
  X(members_surrendered)                                                       \
  X(registration_switch)                                                       \
  X(switch_accepted)                                                           \
  X(registration_query)                                                        \
  X(registration_challenge)                                                    \
  X(switch_node)                                                               \
  X(prove_status)                                                              \
  X(status_proved)                                                             \
  X(node_answered)                                                             \
  X(node_registered)                                                           \
  X(node_departed)                                                             \
  X(resource_query)                                                            \
  X(resource_report)                                                           \
  X(figures_query)                                                             \
  X(figures_report)                                                            \
  X(instance_reservation)                                                      \
  X(instances_reserved)                                                        \
  X(instance_deployment)                                                       \
  X(instance_deployed)                                                         \
  X(instance_removal)                                                          \
  X(instances_removed)                                                         \
  X(instance_changed)                                                          \
  X(event)                                                                     \
  X(state_query)                                                               \
  X(actor_state)                                                               \
  X(record_event)                                                              \
  X(subscribe_events)                                                          \
  X(kept_events_query)                                                         \
  X(kept_events)                                                               \
  X(event_batch)                                                               \
  X(events_written)                                                            \
  X(past_events_query)                                                         \
  X(prepare_image)                                                             \
  X(image_prepared)                                                            \
  X(start_container)                                                           \
  X(container_started)                                                         \
  X(stop_container)                                                            \
  X(container_stopped)                                                         \
  X(remove_container)                                                          \
  X(container_removed)                                                         \
  X(adopt_container)                                                           \
  X(container_adopted)                                                         \
  X(container_exited)                                                          \
  X(fence_container)                                                           \
  X(ask_for_safety)                                                            \
  X(contact_proven)                                                            \
  X(contact_lost)                                                              \
  X(hear_container)                                                            \
  X(ends_acknowledged)                                                         \
  X(instance_notified)                                                         \
  X(program_ended)                                                             \
  X(log_grown)                                                                 \
  X(runtime_problem_changed)                                                   \
  X(engine_answered)                                                           \
  X(engine_streamed)                                                           \
  X(engine_log_read)                                                           \
  X(image_planned)                                                             \
  X(pack_image)                                                                \
  X(image_packed)                                                              \
  X(start_instance)                                                            \
  X(serve_programs)                                                            \
  X(programs_served)                                                           \
  X(follow_server)                                                             \
  X(stop_serving)                                                              \
  X(watch_endpoints)                                                           \
  X(endpoints_missing)                                                         \
  X(graph_changed)                                                             \
  X(use_environment)                                                           \
  X(stop_instance)                                                             \
  X(listen_to_instances)                                                       \
  X(store_record)                                                              \
  X(store_records)                                                             \
  X(record_stored)                                                             \
  X(measure_host)                                                              \
  X(host_measured)                                                             \
  X(measure_use)                                                               \
  X(use_measured)                                                              \
  X(mark_sample)                                                               \
  X(send_frame)                                                                \
  X(frame_received)                                                            \
  X(send_heartbeat)                                                            \
  X(heartbeat_received)                                                        \
  X(close_session)                                                             \
  X(session_closed)                                                            \
  X(own_session)                                                               \
  X(session_admitted)                                                          \
  X(open_session)                                                              \
  X(session_opened)                                                            \
  X(session_settled)                                                           \
  X(find_coordinator)                                                          \
  X(forget_coordinator)                                                        \
  X(coordinator_found)                                                         \
  X(announce_presence)                                                         \
  X(withdraw_presence)                                                         \
  X(presence_seen)                                                             \
  X(presence_gone)                                                             \
  X(resolve_host)                                                              \
  X(host_resolved)                                                             \
  X(probe_server)                                                              \
  X(server_probed)                                                             \
  X(diagnosis_settled)                                                         \
  X(membership_query)                                                          \
  X(membership_state)                                                          \
  X(join_cell)                                                                 \
  X(seek_cell)                                                                 \
  X(leave_cell)                                                                \
  X(register_node)                                                             \
  X(depart_node)                                                               \
  X(member_lost)                                                               \
  X(peer_opened)                                                               \
  X(peer_lost)                                                                 \
  X(peer_status_reported)                                                      \
  X(peer_changed)                                                              \
  X(collect_resources)                                                         \
  X(cell_resources)                                                            \
  X(collect_metrics)                                                           \
  X(metrics_collected)                                                         \
  X(measure_cell)                                                              \
  X(cell_measured)                                                             \
  X(allocate_task)                                                             \
  X(plan_moves)                                                                \
  X(moves_planned)                                                             \
  X(preempt_instances)                                                         \
  X(instances_preempted)                                                       \
  X(record_intent)                                                             \
  X(intent_recorded)                                                           \
  X(record_running)                                                            \
  X(record_failure)                                                            \
  X(task_rolled_back)                                                          \
  X(claim_task)                                                                \
  X(task_claimed)                                                              \
  X(route_request)                                                             \
  X(request_routed)                                                            \
  X(serve_members)                                                             \
  X(relay_request)                                                             \
  X(reach_opening)                                                             \
  X(reach_opened)                                                              \
  X(reach_query)                                                               \
  X(reach_report)                                                              \
  X(reach_settled)                                                             \
  X(examination_query)                                                         \
  X(examination)                                                               \
  X(process_request)                                                           \
  X(request_processed)                                                         \
  X(stop_node)

CAF_BEGIN_TYPE_ID_BLOCK(roscell, caf::first_custom_type_id)

#define ROSCELL_ADD_TYPE_ID(T) CAF_ADD_TYPE_ID(roscell, (roscell::T))
  ROSCELL_MESSAGE_STRUCTS(ROSCELL_ADD_TYPE_ID)
#undef ROSCELL_ADD_TYPE_ID

CAF_END_TYPE_ID_BLOCK(roscell)

namespace caf {
class actor_system_config;
}

namespace roscell {

/// Makes the types known to an actor system; to be called before it is made.
void add_message_types(caf::actor_system_config& config);

} // namespace roscell
