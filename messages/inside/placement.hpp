#pragma once

#include "messages/actors.hpp"
#include "messages/allocation_report.hpp"
#include "messages/rebalance.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"

#include <string>
#include <vector>

/// What a placement starts from, and what the SCHEDULER is asked.
namespace roscell {

/// Asks what the cell has to place something on, of all active members.
struct collect_resources {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// One end of a step that is deployed.
struct deployed_end {
  std::string task;
  std::string step;
  std::string node;
  io_endpoint end;

  static constexpr auto fields() {
    return field_list{required("task", &deployed_end::task),
                      required("step", &deployed_end::step),
                      required("node", &deployed_end::node),
                      required("end", &deployed_end::end)};
  }
};

/// An instance that may have to be preempted, and the room that it holds.
struct evictable_instance {
  preempted_instance who;
  resource_request resources;
  int gpu = -1; ///< Negative: none.

  static constexpr auto fields() {
    return field_list{required("who", &evictable_instance::who),
                      required("resources", &evictable_instance::resources),
                      nullable("gpu", &evictable_instance::gpu)};
  }
};

/// All that a placement starts from.
struct cell_resources {
  std::string cell;
  skill_list skills;
  std::vector<node_resources> nodes;    ///< In the order of their names.
  std::vector<node_agent_actor> agents; ///< One of each node.
  std::vector<deployed_end> written;    ///< What steps in the cell write.
  /// Topics that anybody in the cell writes, ROSCell's own instances too.
  std::vector<io_endpoint> topics;
  std::vector<evictable_instance> evictable; ///< What runs, of any priority.

  static constexpr auto fields() {
    return field_list{required("cell", &cell_resources::cell),
                      required("skills", &cell_resources::skills),
                      required("nodes", &cell_resources::nodes),
                      required("agents", &cell_resources::agents),
                      required("written", &cell_resources::written),
                      required("topics", &cell_resources::topics),
                      required("evictable", &cell_resources::evictable)};
  }
};

/// A build that can do a step.
struct skill_build {
  std::string hash;
  implementation_model model;     ///< Only the deployments to choose from.
  std::vector<std::string> nodes; ///< Those on which it is the candidate.
  bool safe_state = false;        ///< It says when it may be ended.
  /// Those of the nodes that have to fetch it, and what comes then.
  std::vector<std::string> lacking;
  int64_t bytes = 0;

  static constexpr auto fields() {
    return field_list{required("hash", &skill_build::hash),
                      required("model", &skill_build::model),
                      required("nodes", &skill_build::nodes),
                      required("safe_state", &skill_build::safe_state),
                      required("lacking", &skill_build::lacking),
                      required("bytes", &skill_build::bytes)};
  }
};

/// A step of a task request with the builds that can do it, the newest first.
/// On each node one of them is the candidate.
struct resolved_step {
  task_step step; ///< Without short forms.
  std::vector<skill_build> builds;
  /// Steps with the same number, unless it is 0, must share a node: one reads a
  /// file that the other writes.
  uint64_t together = 0;

  static constexpr auto fields() {
    return field_list{required("step", &resolved_step::step),
                      required("builds", &resolved_step::builds),
                      required("together", &resolved_step::together)};
  }
};

/// What the SCHEDULER is asked.
struct allocate_task {
  std::string task;
  std::vector<resolved_step> steps;
  std::vector<node_resources> nodes;
  std::vector<excluded_candidate> excluded;
  std::string why;    ///< A step whose best alternative is asked for.
  bool trial = false; ///< Nothing will come of it but the plan.
  /// What of lower priority may be thought away where the steps do not fit.
  std::vector<evictable_instance> evictable;

  static constexpr auto fields() {
    return field_list{required("task", &allocate_task::task),
                      required("steps", &allocate_task::steps),
                      required("nodes", &allocate_task::nodes),
                      required("excluded", &allocate_task::excluded),
                      required("why", &allocate_task::why),
                      required("trial", &allocate_task::trial),
                      required("evictable", &allocate_task::evictable)};
  }
};

/// A step that runs, and where.
struct running_step {
  std::string instance;
  std::string task;
  resolved_step step;
  std::string node;
  std::string deployment;
  int gpu = -1; ///< Negative: none.
  resource_request resources;

  static constexpr auto fields() {
    return field_list{required("instance", &running_step::instance),
                      required("task", &running_step::task),
                      required("step", &running_step::step),
                      required("node", &running_step::node),
                      required("deployment", &running_step::deployment),
                      nullable("gpu", &running_step::gpu),
                      required("resources", &running_step::resources)};
  }
};

/// What the SCHEDULER is asked about what runs already.
struct plan_moves {
  std::vector<running_step> steps;
  std::vector<node_resources> nodes; ///< The steps' room is in use there.
  double min_gain = 0;
  int64_t most_moves = 0;

  static constexpr auto fields() {
    return field_list{required("steps", &plan_moves::steps),
                      required("nodes", &plan_moves::nodes),
                      required("min_gain", &plan_moves::min_gain),
                      required("most_moves", &plan_moves::most_moves)};
  }
};

/// Moves that each make the score of all steps better, in their order.
struct moves_planned {
  double before = 0;
  double after = 0;
  double lower_bound = 0;
  bool optimal = false;
  std::vector<rebalance_move> moves;

  static constexpr auto fields() {
    return field_list{required("before", &moves_planned::before),
                      required("after", &moves_planned::after),
                      required("lower_bound", &moves_planned::lower_bound),
                      required("optimal", &moves_planned::optimal),
                      required("moves", &moves_planned::moves)};
  }
};

} // namespace roscell
