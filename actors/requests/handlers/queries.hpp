#pragma once

#include "actors/requests/request_context.hpp"

/// Dedicated handlers: questions that one actor of the node answers.
namespace roscell {

void describe_node(const request_context&, node_query,
                   outcome<node_description>);

/// On a primary node, about this node alone.
void describe_local_instances(const request_context&, instance_query,
                              outcome<instance_description>);
void list_local_skills(const request_context&, skill_query,
                       outcome<skill_list>);
void read_local_log(const request_context&, log_query, outcome<log_excerpt>);

/// A node in no cell is told where to register.
void challenge_registration(const request_context&, registration_query,
                            outcome<registration_challenge>);
void switch_registration(const request_context&, registration_switch,
                         outcome<switch_accepted>);

/// On a coordination node, about the whole cell.
void describe_cell(const request_context&, cell_query,
                   outcome<cell_description>);
void list_cells(const request_context&, cell_list_query, outcome<cell_list>);
void describe_tasks(const request_context&, task_query,
                    outcome<task_description>);
void describe_instances(const request_context&, instance_query,
                        outcome<instance_description>);
void list_skills(const request_context&, skill_query, outcome<skill_list>);
void read_log(const request_context&, log_query, outcome<log_excerpt>);
void terminate_task(const request_context&, task_termination,
                    outcome<task_terminated>);
void form_cell(const request_context&, cell_formation, outcome<cell_formed>);
void release_node(const request_context&, node_release, outcome<node_released>);
void transfer_node(const request_context&, node_transfer,
                   outcome<node_transferred>);
void describe_transfers(const request_context&, transfer_query,
                        outcome<transfer_description>);

} // namespace roscell
