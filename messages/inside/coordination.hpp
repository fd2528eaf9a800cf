#pragma once

#include "messages/actors.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/inside/agent.hpp"
#include "messages/inside/link.hpp"
#include "messages/inside/membership.hpp"
#include "messages/rebalance.hpp"
#include "messages/reservation.hpp"

#include <caf/actor.hpp>
#include <caf/actor_addr.hpp>

#include <string>
#include <vector>

/// What is said inside a coordination node.
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

/// A fact: a member's session has ended or its lease has run out.
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

/// A fact: a session with another coordinator is open. The coordinator sends
/// its standing to the peer in return.
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

/// A fact: the session with another coordinator has ended.
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

/// A fact: another coordinator has told its standing.
struct peer_told {
  peer_actor peer;
  cell_standing standing;

  static constexpr auto fields() {
    return field_list{required("peer", &peer_told::peer),
                      required("standing", &peer_told::standing)};
  }
};

/// A fact: another cell has changed.
struct peer_changed {
  peer_actor peer;
  cell_changed change;

  static constexpr auto fields() {
    return field_list{required("peer", &peer_changed::peer),
                      required("change", &peer_changed::change)};
  }
};

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

/// An instance that may have to make way, and the room that it holds.
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

  static constexpr auto fields() {
    return field_list{required("hash", &skill_build::hash),
                      required("model", &skill_build::model),
                      required("nodes", &skill_build::nodes),
                      required("safe_state", &skill_build::safe_state)};
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

/// Has instances of other tasks go, for whose room a task is held already.
struct make_way {
  std::string task;
  std::vector<preempted_instance> preempted;
  bool force = false; ///< Nothing is waited for to be safe.

  static constexpr auto fields() {
    return field_list{required("task", &make_way::task),
                      required("preempted", &make_way::preempted),
                      required("force", &make_way::force)};
  }
};

/// Reply to `make_way`: they are gone.
struct way_made {
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

  static constexpr auto fields() {
    return field_list{required("specs", &intent_recorded::specs),
                      required("agents", &intent_recorded::agents)};
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

/// Asks whether a task request may go on. Tasks take turns from here until
/// their intent is recorded, so that two never count on the same resources.
struct claim_task {
  std::string task;
  std::string request; ///< JSON of the task request.

  static constexpr auto fields() {
    return field_list{required("task", &claim_task::task),
                      required("request", &claim_task::request)};
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

/// A request as it came in at an edge.
struct route_request {
  std::string text; ///< Bytes from outside, not checked yet.
  std::string only; ///< The one type that is allowed; empty: any.

  static constexpr auto fields() {
    return field_list{required("text", &route_request::text),
                      required("only", &route_request::only)};
  }
};

/// The answer: a reply or an error, as JSON text.
struct request_routed {
  std::string text;
  /// Code of a refusal; empty when the request was done.
  std::string refusal;

  static constexpr auto fields() {
    return field_list{required("text", &request_routed::text),
                      required("refusal", &request_routed::refusal)};
  }
};

/// A request that a member of the cell is to answer itself.
struct relay_request {
  std::string node;
  std::string text; ///< JSON of the request, checked.

  static constexpr auto fields() {
    return field_list{required("node", &relay_request::node),
                      required("text", &relay_request::text)};
  }
};

/// Who answers what comes over a session: to the COORDINATOR, what its members
/// ask on behalf of their users; to the MEMBERSHIP, what its coordinator asks.
struct serve_members {
  request_router_actor router;

  static constexpr auto fields() {
    return field_list{required("router", &serve_members::router)};
  }
};

/// Begins the work on the request that the pipeline was made for.
struct process_request {
  static constexpr auto fields() {
    return field_list{};
  }
};

struct request_processed {
  std::string text; ///< JSON of the reply.

  static constexpr auto fields() {
    return field_list{required("text", &request_processed::text)};
  }
};

/// Ends the node in order: leaves the cell, closes the edges, keeps instances.
struct stop_node {
  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
