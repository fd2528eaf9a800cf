#include "actors/requests/handler_pipeline.hpp"

#include "actors/builds/limits.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/placement/limits.hpp"
#include "actors/requests/handlers/forwarding.hpp"
#include "actors/requests/handlers/insight.hpp"
#include "actors/requests/handlers/task_pipeline.hpp"
#include "actors/requests/limits.hpp"

namespace roscell {

namespace {

using services = node_services;

constexpr std::chrono::milliseconds soon = limits::local::answer;

/// A log may be waited for; the answer comes soon after that.
std::chrono::milliseconds log_timeout(const log_query& query) {
  return limits::log::answer + std::chrono::milliseconds{query.wait_ms};
}

void add_node_requests(request_registry& registry) {
  registry.add(
      forward_within<node_query, node_description>(soon, &services::node));
  registry.add(forward_within<hello_query, node_hello>(soon, &services::node));
  registry.add(inspect_actors);
  registry.add(report_cost);
  registry.add(
      forward_within<reach_opening, reach_opened>(soon, &services::prober));
  registry.add(
      forward_within<reach_query, reach_report>(soon, &services::prober));
  registry.add(check_host);
  registry.add(forward_within<exec_request, exec_started>(
      *relayed_limit(exec_request::type), &services::execs));
  registry.add(
      forward_within<exec_input, exec_input_taken>(soon, &services::execs));
  registry.add(
      forward_within<exec_output_query, exec_output>(soon, &services::execs));
  registry.add(
      forward_within<secret_setting, secret_set>(soon, &services::secrets));
  registry.add(
      forward_within<secret_query, secret_list>(soon, &services::secrets));
  registry.add(
      forward_within<secret_removal, secret_removed>(soon, &services::secrets));
}

/// What a node is at its site, and who has changed what on it.
void add_site_requests(request_registry& registry) {
  const auto whom = &services::site;
  registry.add(forward_within<site_query, site_status>(soon, whom));
  registry.add(forward_within<site_invitation, site_invited>(soon, whom));
  registry.add(forward_within<site_entry, site_entered>(soon, whom));
  registry.add(forward_within<site_renewal, site_entered>(soon, whom));
  registry.add(
      forward_within<identity_request_query, identity_requested>(soon, whom));
  registry.add(forward_within<identity_setting, identity_set>(soon, whom));
  registry.add(forward_within<revocation_setting, revocations_set>(soon, whom));
  registry.add(forward_within<audit_query, audit_list>(soon, &services::audit));
}

void add_primary_requests(request_registry& registry) {
  registry.add(forward_or_ask_cell<instance_query, instance_description>(
      &services::supervisor, [](const instance_query&) { return soon; }));
  registry.add(list_local_skills);
  registry.add(forward_or_ask_cell<log_query, log_excerpt>(
      &services::supervisor, log_timeout));
  registry.add(
      forward_within<kept_logs_query, kept_logs>(soon, &services::supervisor));
  registry.add(forward_within<registration_query, registration_challenge>(
      soon, &services::membership));
  registry.add(forward_within<registration_switch, switch_accepted>(
      soon, &services::membership));
}

void add_cell_queries(request_registry& registry) {
  const auto whom = &services::coordinator;
  registry.add(forward_within<cell_query, cell_description>(soon, whom));
  registry.add(forward_within<cell_list_query, cell_list>(soon, whom));
  registry.add(forward_within<topic_query, topic_list>(soon, whom));
  registry.add(forward_within<task_query, task_description>(soon, whom));
  registry.add(
      forward_within<task_revisions_query, task_revisions>(soon, whom));
  registry.add(await_task_change);
  registry.add(forward_within<task_history_query, task_history>(soon, whom));
  registry.add(start_with("read_resources", read_resources)
                   .then("tell_cell", report_cell));
  registry.add(report_placement);
  registry.add(list_traces);
  registry.add(
      forward_within<instance_query, instance_description>(soon, whom));
  registry.add(forward_within<skill_query, skill_list>(soon, whom));
  registry.add(
      forward_within<transfer_query, transfer_description>(soon, whom));
  registry.add(forward_to<log_query, log_excerpt>(whom, log_timeout));
  registry.add(forward_within<kept_logs_query, kept_logs>(soon, whom));
}

void add_cell_commands(request_registry& registry) {
  const auto whom = &services::coordinator;
  registry.add(forward_within<task_termination, task_terminated>(
      limits::task::termination, whom));
  registry.add(forward_within<task_restart, task_restarted>(
      limits::task::restart, whom));
  registry.add(forward_within<task_update, task_update_plan>(
      limits::task::restart, whom));
  registry.add(forward_within<task_set_request, task_set_plan>(
      limits::task::restart, whom));
  registry.add(forward_within<parameter_change, parameters_changed>(
      limits::task::parameters, whom));
  registry.add(forward_within<node_drain, node_drained>(soon, whom));
  registry.add(forward_within<node_undrain, node_undrained>(soon, whom));
  registry.add(forward_within<skill_addition, skill_added>(
      limits::build::addition, whom));
  registry.add(forward_within<skill_removal, skill_removed>(soon, whom));
  registry.add(
      forward_within<skill_pull, skill_pulled>(limits::build::pull, whom));
  registry.add(forward_within<cell_rebalance, cell_rebalanced>(
      limits::task::search + soon, whom));
  registry.add(forward_within<cell_formation, cell_formed>(
      limits::transfer::answer, whom));
  registry.add(forward_within<node_release, node_released>(
      limits::transfer::answer, whom));
  registry.add(forward_within<node_transfer, node_transferred>(
      limits::transfer::answer, whom));
}

void add_task_pipelines(request_registry& registry) {
  registry.add(start_with("claim_task", claim)
                   .then("resolve_skills", resolve_skills)
                   .then("reserve", place_with_room)
                   .then("record_intent", record_plan)
                   .then("preempt_instances", have_instances_preempted)
                   .then("deploy", deploy)
                   .then("record_outcome", record_result));
  registry.add(start_with("collect_resources", adopt_plan_query)
                   .then("resolve_skills", resolve_skills)
                   .then("allocate", place)
                   .then("present_plan", present_plan));
}

void add_cell_requests(request_registry& registry) {
  add_cell_queries(registry);
  add_cell_commands(registry);
  add_task_pipelines(registry);
}

} // namespace

request_registry make_registry(bool coordinator) {
  request_registry result;
  add_node_requests(result);
  add_site_requests(result);
  if (coordinator)
    add_cell_requests(result);
  else
    add_primary_requests(result);
  return result;
}

} // namespace roscell
