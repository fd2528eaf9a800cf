#pragma once

#include "actors/placement/instance_specs.hpp"
#include "actors/requests/request_context.hpp"
#include "messages/task.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The handlers of `task_request` and `task_plan_query`. Each one's output is
/// the next one's input; registry.cpp puts them in order.
namespace roscell {

/// What a plan query thinks otherwise than the cell is.
struct what_if {
  std::vector<std::string> without;
  std::vector<node_resources> with;
  std::string why; ///< A step whose best alternative is asked for.
};

/// A request that has the placement lock.
struct claimed_task {
  task_request request;
  cell_resources cell;
  what_if other;
};

struct resolved_task {
  task_request request;
  std::vector<resolved_step> steps;
  std::vector<std::string> warnings;
  cell_resources cell;
  std::string why;
};

/// Placed where the members keep room for it.
struct reserved_task {
  allocated_task task;
  std::vector<instance_spec> specs;
  std::vector<excluded_candidate> refused;
};

/// What will be deployed where; the resources are held.
struct intended_task {
  std::string task;
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes;       ///< Node of each spec.
  std::vector<node_agent_actor> agents; ///< The same.
  std::vector<build_offer> offers; ///< Where it gets the build, if it lacks it.
  std::vector<preempted_instance> preempted; ///< They have to go before.
  bool force = false;     ///< They are not waited for to be stop-safe.
  bool cpu_floor = false; ///< As in the plan.
};

/// How the deployment of the steps went.
struct deployed_task {
  std::string task;
  std::optional<failure> problem; ///< Of the first step that did not come up.
};

/// Waits for the placement lock. The same request again ends here with the
/// first reply.
void claim(const request_context&, task_request, outcome<claimed_task>);
/// A plan takes no placement lock: it holds nothing.
void adopt_plan_query(const request_context&, task_plan_query,
                      outcome<claimed_task>);
void resolve_skills(const request_context&, claimed_task,
                    outcome<resolved_task>);
void place(const request_context&, resolved_task, outcome<allocated_task>);
void present_plan(const request_context&, allocated_task, outcome<task_plan>);
/// Allocates, and has the members keep room; where one refuses, again without
/// what it refused. In placement.cpp.
void place_with_room(const request_context&, resolved_task,
                     outcome<reserved_task>);
void record_plan(const request_context&, reserved_task, outcome<intended_task>);
/// Has instances of lower priority go where the plan says so, and the members
/// keep the room. In preempting.cpp.
void have_instances_preempted(const request_context&, intended_task,
                              outcome<intended_task>);
/// Starts the steps, each once those run whose files it reads, and waits until
/// all run or one has failed.
void deploy(const request_context&, intended_task, outcome<deployed_task>);
/// Has the coordinator undo what was placed, then calls `done` with the failure
/// as it is to be told.
void undo_placement(const request_context&, const std::string& task,
                    failure why,
                    const std::function<void(const failure&)>& done);
/// A failed deployment is rolled back before its error is returned.
void record_result(const request_context&, deployed_task,
                   outcome<task_accepted>);

/// How a task stands, once that is something else than the asker knows, or when
/// his wait is over. So a task is watched without polling, over any number of
/// hops. Errors: conflict (too many wait).
void await_task_change(const request_context& context, task_change_query query,
                       outcome<task_change> done);

/// What of a task makes an asker of its changes hear of it: the states and
/// places of its instances, not their metrics.
std::string mark_of(const task_description& task);

} // namespace roscell
