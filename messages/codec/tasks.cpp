#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/codec/instantiate.hpp"
#include "messages/insight/examination.hpp"
#include "messages/insight/request_trace.hpp"
#include "messages/reservation.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"

namespace roscell {

ROSCELL_CODEC(allocation_score)
ROSCELL_CODEC(resource_fractions)
ROSCELL_CODEC(step_allocation)
ROSCELL_CODEC(rejection_cause)
ROSCELL_CODEC(rejected_candidate)
ROSCELL_CODEC(excluded_candidate)
ROSCELL_CODEC(resource_use)
ROSCELL_CODEC(step_alternative)
ROSCELL_CODEC(task_plan)
ROSCELL_CODEC(awaited_step)
ROSCELL_CODEC(task_accepted)
ROSCELL_CODEC(plan_document)
ROSCELL_CODEC(instance_reservation)
ROSCELL_CODEC(refused_instance)
ROSCELL_CODEC(instances_reserved)
ROSCELL_CODEC(installed_skill)
ROSCELL_CODEC(skill_problem)
ROSCELL_CODEC(refused_skill)
ROSCELL_CODEC(skill_query)
ROSCELL_CODEC(skill_row)
ROSCELL_CODEC(skill_list)
ROSCELL_CODEC(port_description)
ROSCELL_CODEC(scheduling_request)
ROSCELL_CODEC(deployment_option)
ROSCELL_CODEC(implementation_model)
ROSCELL_CODEC(ros2_program)
ROSCELL_CODEC(skill_descriptor)
ROSCELL_CODEC(fresh_cell_query)
ROSCELL_CODEC(actor_query)
ROSCELL_CODEC(inspected_actor_row)
ROSCELL_CODEC(actor_inspection)
ROSCELL_CODEC(task_placement_query)
ROSCELL_CODEC(task_placement)
ROSCELL_CODEC(request_trace_query)
ROSCELL_CODEC(trace_question)
ROSCELL_CODEC(trace_hop)
ROSCELL_CODEC(request_trace)
ROSCELL_CODEC(request_traces)
ROSCELL_CODEC(task_step)
ROSCELL_CODEC(task_request)
ROSCELL_CODEC(task_plan_query)
ROSCELL_CODEC(placed_instance)
ROSCELL_CODEC(preempted_instance)
ROSCELL_CODEC(task_termination)
ROSCELL_CODEC(task_terminated)
ROSCELL_CODEC(task_restart)
ROSCELL_CODEC(task_restarted)
ROSCELL_CODEC(task_row)
ROSCELL_CODEC(task_history_query)
ROSCELL_CODEC(task_history)
ROSCELL_CODEC(task_query)
ROSCELL_CODEC(task_description)
ROSCELL_CODEC(task_change_query)
ROSCELL_CODEC(task_change)

} // namespace roscell
