#pragma once

#include "messages/actors.hpp"
#include "messages/cell.hpp"
#include "messages/inside/membership.hpp"
#include "messages/inside/placement.hpp"
#include "messages/task.hpp"

#include <string>
#include <vector>

/// What the CELL COORDINATOR is told of its members and of other coordinators,
/// and asked for a task.
namespace roscell {

/// A member behind a session asks for its row.
struct register_node {
  node_registration registration;
  member_actor member;

  static constexpr auto fields() {
    return field_list{required("registration", &register_node::registration),
                      required("member", &register_node::member)};
  }
};

/// A member leaves in order.
struct depart_node {
  std::string uuid;
  member_actor member; ///< Ignored unless it is the row's present one.
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("uuid", &depart_node::uuid),
                      required("member", &depart_node::member),
                      required("reason", &depart_node::reason)};
  }
};

/// An event: a member's session has ended or its lease has run out.
struct member_lost {
  std::string uuid;
  member_actor member; ///< Ignored unless it is the row's present one.
  std::string reason;
  int64_t silent_ms = 0; ///< Since its last word.

  static constexpr auto fields() {
    return field_list{required("uuid", &member_lost::uuid),
                      required("member", &member_lost::member),
                      required("reason", &member_lost::reason),
                      required("silent_ms", &member_lost::silent_ms)};
  }
};

/// An event: a member has other skills.
struct member_skills_changed {
  std::string uuid;
  member_actor member; ///< Ignored unless it is the row's present one.
  skills_changed now;

  static constexpr auto fields() {
    return field_list{required("uuid", &member_skills_changed::uuid),
                      required("member", &member_skills_changed::member),
                      required("now", &member_skills_changed::now)};
  }
};

/// An event: a session with another coordinator is open. The coordinator sends
/// its status to the peer in return.
struct peer_opened {
  peer_actor peer;
  std::string uuid;        ///< Of the other coordination node.
  bool opened_here = true; ///< Else the other one came to us.

  static constexpr auto fields() {
    return field_list{required("peer", &peer_opened::peer),
                      required("uuid", &peer_opened::uuid),
                      required("opened_here", &peer_opened::opened_here)};
  }
};

/// An event: the session with another coordinator has ended.
struct peer_lost {
  peer_actor peer;
  std::string uuid;
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("peer", &peer_lost::peer),
                      required("uuid", &peer_lost::uuid),
                      required("reason", &peer_lost::reason)};
  }
};

/// An event: another coordinator has told its status.
struct peer_status_reported {
  peer_actor peer;
  cell_standing status;

  static constexpr auto fields() {
    return field_list{required("peer", &peer_status_reported::peer),
                      required("standing", &peer_status_reported::status)};
  }
};

/// An event: another cell has changed.
struct peer_changed {
  peer_actor peer;
  cell_changed change;

  static constexpr auto fields() {
    return field_list{required("peer", &peer_changed::peer),
                      required("change", &peer_changed::change)};
  }
};

/// Has instances of other tasks go, for whose room a task is held already.
struct preempt_instances {
  std::string task;
  std::vector<preempted_instance> preempted;
  bool force = false; ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("task", &preempt_instances::task),
                      required("preempted", &preempt_instances::preempted),
                      required("force", &preempt_instances::force)};
  }
};

/// Reply to `preempt_instances`: they are gone.
struct instances_preempted {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Holds the resources of an allocation from now on.
struct record_intent {
  std::string task;
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes; ///< Node of each spec.
  task_accepted decision;         ///< Why so; without the instances.

  static constexpr auto fields() {
    return field_list{required("task", &record_intent::task),
                      required("specs", &record_intent::specs),
                      required("nodes", &record_intent::nodes),
                      required("decision", &record_intent::decision)};
  }
};

struct intent_recorded {
  std::vector<instance_spec> specs;     ///< Completed with what the cell adds.
  std::vector<node_agent_actor> agents; ///< Agent of each spec's node.
  /// Where each node gets the build, unless it has it.
  std::vector<build_offer> offers;

  static constexpr auto fields() {
    return field_list{required("specs", &intent_recorded::specs),
                      required("agents", &intent_recorded::agents),
                      required("offers", &intent_recorded::offers)};
  }
};

/// All steps of a deployment run.
struct record_running {
  std::string task;

  static constexpr auto fields() {
    return field_list{required("task", &record_running::task)};
  }
};

/// A step of a deployment has not come up.
struct record_failure {
  std::string task;
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("task", &record_failure::task),
                      required("reason", &record_failure::reason)};
  }
};

struct task_rolled_back {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Asks whether a task request may go on. One holds the placement lock from
/// here until its intent is recorded, so that two never count on the same
/// resources.
struct claim_task {
  std::string task;
  std::string request;    ///< JSON of the task request.
  std::string request_id; ///< Under which it runs once; may be empty.
  bool force = false;   ///< Hosts that start steps of that name alone are off.
  bool replace = false; ///< As in `task_request`.

  static constexpr auto fields() {
    return field_list{required("task", &claim_task::task),
                      required("request", &claim_task::request),
                      optional("force", &claim_task::force),
                      optional("replace", &claim_task::replace),
                      optional("request_id", &claim_task::request_id)};
  }
};

struct task_claimed {
  bool known = false;     ///< The same request has been done already.
  task_accepted accepted; ///< Then its reply.
  cell_resources cell;    ///< Else what the task may be placed on.

  static constexpr auto fields() {
    return field_list{required("known", &task_claimed::known),
                      required("accepted", &task_claimed::accepted),
                      required("cell", &task_claimed::cell)};
  }
};

/// Asks what the skills of a whole cell say of themselves.
struct collect_metrics {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// What they say is known now, as far as their nodes have answered in time.
struct metrics_collected {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Asks for all that can be counted of a cell, as it is known.
struct measure_cell {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// A node of the cell.
struct node_measures {
  row_state state = row_state::expected;
  node_resources resources;

  static constexpr auto fields() {
    return field_list{required("state", &node_measures::state),
                      required("resources", &node_measures::resources)};
  }
};

/// An instance, without what only people read.
struct instance_measures {
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  instance_state state = instance_state::pending;
  int64_t restarts = 0;
  instance_metrics metrics;
  instance_health health = instance_health::good;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_measures::instance),
                      required("task", &instance_measures::task),
                      required("step", &instance_measures::step),
                      required("node", &instance_measures::node),
                      required("state", &instance_measures::state),
                      required("restarts", &instance_measures::restarts),
                      required("figures", &instance_measures::metrics),
                      required("health", &instance_measures::health)};
  }
};

inline instance_measures measures_of(const instance_row& row) {
  return {row.spec.instance, row.spec.task, row.spec.step, row.node,
          row.state,         row.restarts,  row.metrics,   row.health};
}

/// Tasks that are in one state.
struct task_count {
  task_state state = task_state::deploying;
  int64_t tasks = 0;

  static constexpr auto fields() {
    return field_list{required("state", &task_count::state),
                      required("tasks", &task_count::tasks)};
  }
};

/// Reply to `measure_cell`.
struct cell_measured {
  std::vector<node_measures> nodes;
  std::vector<instance_measures> instances;
  std::vector<task_count> tasks; ///< Of every state.

  static constexpr auto fields() {
    return field_list{required("nodes", &cell_measured::nodes),
                      required("instances", &cell_measured::instances),
                      required("tasks", &cell_measured::tasks)};
  }
};

} // namespace roscell
