#include "test/messages/trial.hpp"

#include "actors/edge/session/session_frames.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/event.hpp"
#include "messages/exec.hpp"
#include "messages/image.hpp"
#include "messages/insight/examination.hpp"
#include "messages/insight/node_cost.hpp"
#include "messages/insight/reach.hpp"
#include "messages/insight/request_trace.hpp"
#include "messages/kept_log.hpp"
#include "messages/parameter_change.hpp"
#include "messages/rebalance.hpp"
#include "messages/reservation.hpp"
#include "messages/secret.hpp"
#include "messages/session.hpp"
#include "messages/site.hpp"
#include "messages/task_set.hpp"
#include "messages/topic.hpp"
#include "schemas/document.hpp"
#include "test/messages/member_count.hpp"
#include "test/messages/sample.hpp"

#include <utility>

namespace roscell::test {

namespace {

template <class T>
bool decodes(const json& document) {
  return std::holds_alternative<T>(decode<T>(document));
}

template <class T>
bool survives(const json& document, const T& sample) {
  auto parsed = parse_document(document.dump());
  if (!std::holds_alternative<json>(parsed))
    return false;
  auto result = decode<T>(std::get<json>(parsed));
  return std::holds_alternative<T>(result) && std::get<T>(result) == sample;
}

template <class T>
json encoded(const T& sample) {
  if constexpr (has_message_type<T>::value)
    return message_json(sample);
  else
    return sample;
}

template <class T>
trial try_part(std::string name) {
  trial result;
  result.name = std::move(name);
  result.members = member_count<T>();
  result.fields = decltype(T::fields())::size;
  const auto full = sampler{extent::full}.make<T>();
  result.full = encoded(full);
  result.full_survives = survives(result.full, full);
  const auto least = sampler{extent::least}.make<T>();
  result.least = encoded(least);
  result.least_survives = survives(result.least, least);
  result.decodes = decodes<T>;
  return result;
}

template <class... Ts>
void try_messages(std::vector<trial>& result) {
  (result.push_back(try_part<Ts>(Ts::type)), ...);
}

} // namespace

std::vector<trial> message_trials() {
  std::vector<trial> result;
  try_messages<cell_query, cell_list_query, topic_query, task_request,
               task_plan_query, task_query, task_change_query,
               task_history_query, task_placement_query, request_trace_query,
               actor_query, fresh_cell_query, task_termination, task_restart,
               instance_query, log_query, kept_logs_query, node_query,
               hello_query, skill_query>(result);
  try_messages<cell_description, cell_list, topic_list, task_accepted,
               task_plan, task_description, task_change, task_history,
               task_placement, request_traces, actor_inspection,
               task_terminated, task_restarted, instance_description,
               log_excerpt, kept_logs, node_description, node_hello, skill_list,
               event>(result);
  try_messages<session_request, session_reply, session_notice,
               node_registration, node_registered, node_departure,
               node_departed, resource_query, resource_report, figures_query,
               figures_report, instance_deployment, instance_deployed,
               instance_removal, instances_removed, instance_changed,
               skills_changed, instance_reservation, instances_reserved>(
      result);
  try_messages<cell_formation, cell_formed, node_release, node_released,
               node_drain, node_drained, node_undrain, node_undrained,
               cell_rebalance, cell_rebalanced, node_transfer, node_transferred,
               transfer_query, transfer_description, registration_query,
               registration_challenge, registration_switch, switch_accepted>(
      result);
  try_messages<cost_query, cost_report, reach_opening, reach_opened,
               reach_query, reach_report, examination_query, examination>(
      result);
  try_messages<cell_standing, cell_changed, place_request, place_granted,
               place_reservation, place_reserved, member_surrender,
               members_surrendered>(result);
  try_messages<skill_addition, skill_added, skill_removal, skill_removed,
               skill_pull, skill_pulled, build_keeping, build_kept,
               build_release, build_released>(result);
  try_messages<task_update, task_update_plan, task_revisions_query,
               task_revisions, task_set_request, task_set_plan,
               parameter_change, parameters_changed, set_parameters,
               parameters_set>(result);
  try_messages<secret_setting, secret_set, secret_query, secret_list,
               secret_removal, secret_removed>(result);
  try_messages<site_query, site_status, site_invitation, site_invited,
               site_entry, site_renewal, site_entered, identity_request_query,
               identity_requested, identity_setting, identity_set,
               revocation_setting, revocations_set, audit_query, audit_list>(
      result);
  try_messages<image_request, image_offered, image_query, image_known,
               image_sharing, image_shared>(result);
  try_messages<exec_request, exec_started, exec_input, exec_input_taken,
               exec_output_query, exec_output>(result);
  try_messages<session_hello, session_challenge, session_proof,
               session_accepted>(result);
  result.push_back(try_part<skill_descriptor>("skill_descriptor"));
  result.push_back(try_part<plan_document>("plan_document"));
  result.push_back(try_part<build_manifest>("build_manifest"));
  return result;
}

std::vector<trial> part_trials() {
  return {
      try_part<amount>("amount"),
      try_part<gpu_resources>("gpu_resources"),
      try_part<node_resources>("node_resources"),
      try_part<resource_request>("resource_request"),
      try_part<io_endpoint>("io_endpoint"),
      try_part<restart_policy>("restart_policy"),
      try_part<node_loss_policy>("node_loss_policy"),
      try_part<stream_bounds>("stream_bounds"),
      try_part<health_policy>("health_policy"),
      try_part<life_policy>("life_policy"),
      try_part<ended_run>("ended_run"),
      try_part<safety_wait>("safety_wait"),
      try_part<instance_spec>("instance_spec"),
      try_part<instance_row>("instance_row"),
      try_part<node_identity>("node_identity"),
      try_part<actor_row>("actor_row"),
      try_part<registry_row>("registry_row"),
      try_part<cell_row>("cell_row"),
      try_part<port_description>("port_description"),
      try_part<deployment_option>("deployment_option"),
      try_part<implementation_model>("implementation_model"),
      try_part<installed_skill>("installed_skill"),
      try_part<skill_row>("skill_row"),
      try_part<skill_problem>("skill_problem"),
      try_part<refused_skill>("refused_skill"),
      try_part<task_step>("task_step"),
      try_part<placed_instance>("placed_instance"),
      try_part<preempted_instance>("preempted_instance"),
      try_part<rebalance_move>("rebalance_move"),
      try_part<inspected_actor_row>("inspected_actor_row"),
      try_part<trace_question>("trace_question"),
      try_part<trace_hop>("trace_hop"),
      try_part<request_trace>("request_trace"),
      try_part<task_row>("task_row"),
      try_part<task_set_row>("task_set_row"),
      try_part<allocation_score>("allocation_score"),
      try_part<resource_fractions>("resource_fractions"),
      try_part<step_allocation>("step_allocation"),
      try_part<rejection_cause>("rejection_cause"),
      try_part<rejected_candidate>("rejected_candidate"),
      try_part<excluded_candidate>("excluded_candidate"),
      try_part<resource_use>("resource_use"),
      try_part<step_alternative>("step_alternative"),
      try_part<refused_instance>("refused_instance"),
      try_part<instance_verdict>("instance_verdict"),
  };
}

} // namespace roscell::test
