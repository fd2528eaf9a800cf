#include "messages/codec/instantiate.hpp"
#include "messages/event.hpp"
#include "messages/failure.hpp"
#include "messages/insight/examination.hpp"
#include "messages/insight/node_cost.hpp"
#include "messages/insight/reach.hpp"
#include "messages/instance.hpp"
#include "messages/kept_log.hpp"
#include "messages/node.hpp"
#include "messages/resources.hpp"
#include "messages/session.hpp"

namespace roscell {

ROSCELL_CODEC(event)
ROSCELL_CODEC(failure)
ROSCELL_CODEC(io_endpoint)
ROSCELL_CODEC(restart_policy)
ROSCELL_CODEC(node_loss_policy)
ROSCELL_CODEC(stream_bounds)
ROSCELL_CODEC(health_policy)
ROSCELL_CODEC(life_policy)
ROSCELL_DESCRIBED(stream_metrics)
ROSCELL_CODEC(ended_run)
ROSCELL_CODEC(safety_wait)
ROSCELL_CODEC(instance_spec)
ROSCELL_CODEC(stream_count)
ROSCELL_CODEC(instance_use)
ROSCELL_CODEC(instance_metrics)
ROSCELL_CODEC(instance_row)
ROSCELL_CODEC(instance_query)
ROSCELL_CODEC(instance_description)
ROSCELL_CODEC(log_query)
ROSCELL_CODEC(log_excerpt)
ROSCELL_CODEC(kept_log)
ROSCELL_CODEC(kept_logs_query)
ROSCELL_CODEC(kept_logs)
ROSCELL_CODEC(node_identity)
ROSCELL_CODEC(actor_row)
ROSCELL_CODEC(node_query)
ROSCELL_CODEC(join_failure)
ROSCELL_CODEC(hello_query)
ROSCELL_CODEC(node_hello)
ROSCELL_CODEC(discovery_place)
ROSCELL_CODEC(node_description)
ROSCELL_CODEC(amount)
ROSCELL_CODEC(gpu_resources)
ROSCELL_CODEC(node_resources)
ROSCELL_CODEC(resource_request)
ROSCELL_CODEC(session_request)
ROSCELL_CODEC(session_reply)
ROSCELL_CODEC(session_notice)
ROSCELL_CODEC(node_registration)
ROSCELL_CODEC(instance_verdict)
ROSCELL_CODEC(node_registered)
ROSCELL_CODEC(node_departure)
ROSCELL_CODEC(node_departed)
ROSCELL_CODEC(resource_query)
ROSCELL_CODEC(resource_report)
ROSCELL_CODEC(figures_query)
ROSCELL_CODEC(instance_status_text)
ROSCELL_CODEC(figures_report)
ROSCELL_CODEC(instance_deployment)
ROSCELL_CODEC(instance_deployed)
ROSCELL_CODEC(instance_removal)
ROSCELL_CODEC(instances_removed)
ROSCELL_CODEC(instance_changed)
ROSCELL_CODEC(skills_changed)
ROSCELL_CODEC(cost_query)
ROSCELL_CODEC(peer_traffic)
ROSCELL_CODEC(cost_window)
ROSCELL_CODEC(node_cost)
ROSCELL_CODEC(cost_report)
ROSCELL_CODEC(reach_opening)
ROSCELL_CODEC(reach_opened)
ROSCELL_CODEC(reach_goal)
ROSCELL_CODEC(reach_query)
ROSCELL_CODEC(reach_row)
ROSCELL_CODEC(reach_report)
ROSCELL_CODEC(examination_query)
ROSCELL_CODEC(finding)
ROSCELL_CODEC(examination)

} // namespace roscell
