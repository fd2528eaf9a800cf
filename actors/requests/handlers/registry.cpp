#include "actors/requests/handlers/registry.hpp"

#include "actors/requests/handlers/queries.hpp"
#include "actors/requests/handlers/task_pipeline.hpp"

namespace roscell {

namespace {

void add_node_requests(request_registry& registry) {
  registry.add(describe_node);
}

void add_primary_requests(request_registry& registry) {
  registry.add(describe_local_instances);
  registry.add(list_local_skills);
  registry.add(read_local_log);
  registry.add(challenge_registration);
  registry.add(switch_registration);
}

void add_cell_requests(request_registry& registry) {
  registry.add(describe_cell);
  registry.add(list_cells);
  registry.add(describe_tasks);
  registry.add(describe_instances);
  registry.add(list_skills);
  registry.add(read_log);
  registry.add(terminate_task);
  registry.add(form_cell);
  registry.add(release_node);
  registry.add(transfer_node);
  registry.add(describe_transfers);
  registry.add(start_with("claim_task", claim)
                   .then("resolve_skills", resolve_skills)
                   .then("reserve", place_with_room)
                   .then("record_intent", record_plan)
                   .then("deploy", deploy)
                   .then("record_outcome", record_result));
  registry.add(start_with("collect_resources", adopt_plan_query)
                   .then("resolve_skills", resolve_skills)
                   .then("allocate", place)
                   .then("present_plan", present_plan));
}

} // namespace

request_registry make_registry(bool coordinator) {
  request_registry result;
  add_node_requests(result);
  if (coordinator)
    add_cell_requests(result);
  else
    add_primary_requests(result);
  return result;
}

} // namespace roscell
