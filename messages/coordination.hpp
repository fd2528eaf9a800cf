#pragma once

#include "messages/agent.hpp"
#include "messages/allocation_report.hpp"
#include "messages/cell.hpp"
#include "messages/link.hpp"
#include "messages/membership.hpp"
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
    return std::make_tuple(
        required("registration", &register_node::registration),
        required("member", &register_node::member));
  }
};

/// A member leaves in order.
struct depart_node {
  std::string uuid;
  member_actor member; ///< Ignored unless it is the row's present one.
  std::string reason;

  static constexpr auto fields() {
    return std::make_tuple(required("uuid", &depart_node::uuid),
                           required("member", &depart_node::member),
                           required("reason", &depart_node::reason));
  }
};

/// A fact: a member's session has ended or its lease has run out.
struct member_lost {
  std::string uuid;
  member_actor member; ///< Ignored unless it is the row's present one.
  std::string reason;

  static constexpr auto fields() {
    return std::make_tuple(required("uuid", &member_lost::uuid),
                           required("member", &member_lost::member),
                           required("reason", &member_lost::reason));
  }
};

/// A fact: a session with another coordinator is open. The coordinator sends
/// its standing to the peer in return.
struct peer_opened {
  peer_actor peer;
  std::string uuid;        ///< Of the other coordination node.
  bool opened_here = true; ///< Else the other one came to us.

  static constexpr auto fields() {
    return std::make_tuple(required("peer", &peer_opened::peer),
                           required("uuid", &peer_opened::uuid),
                           required("opened_here", &peer_opened::opened_here));
  }
};

/// A fact: the session with another coordinator has ended.
struct peer_lost {
  peer_actor peer;
  std::string uuid;
  std::string reason;

  static constexpr auto fields() {
    return std::make_tuple(required("peer", &peer_lost::peer),
                           required("uuid", &peer_lost::uuid),
                           required("reason", &peer_lost::reason));
  }
};

/// A fact: another coordinator has told its standing.
struct peer_told {
  peer_actor peer;
  cell_standing standing;

  static constexpr auto fields() {
    return std::make_tuple(required("peer", &peer_told::peer),
                           required("standing", &peer_told::standing));
  }
};

/// A fact: another cell has changed.
struct peer_changed {
  peer_actor peer;
  cell_changed change;

  static constexpr auto fields() {
    return std::make_tuple(required("peer", &peer_changed::peer),
                           required("change", &peer_changed::change));
  }
};

/// Asks all active members for their resources.
struct collect_resources {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// Asks who speaks for nodes.
struct find_agents {
  std::vector<std::string> nodes;

  static constexpr auto fields() {
    return std::make_tuple(required("nodes", &find_agents::nodes));
  }
};

struct agents_found {
  std::string cell;
  std::vector<node_agent_actor> agents; ///< One of each node.

  static constexpr auto fields() {
    return std::make_tuple(required("cell", &agents_found::cell),
                           required("agents", &agents_found::agents));
  }
};

struct cell_resources {
  std::vector<node_resources> nodes; ///< In the order of their names.

  static constexpr auto fields() {
    return std::make_tuple(required("nodes", &cell_resources::nodes));
  }
};

/// A step of a task request with the skill that it names.
struct resolved_step {
  task_step step;
  installed_skill skill;
  implementation_model model;     ///< Only the deployments to choose from.
  std::vector<std::string> nodes; ///< Those that have the skill.

  static constexpr auto fields() {
    return std::make_tuple(required("step", &resolved_step::step),
                           required("skill", &resolved_step::skill),
                           required("model", &resolved_step::model),
                           required("nodes", &resolved_step::nodes));
  }
};

/// What the SCHEDULER is asked.
struct allocate_task {
  std::string task;
  std::vector<resolved_step> steps;
  std::vector<node_resources> nodes;
  std::vector<excluded_candidate> excluded;
  std::string why; ///< A step whose best alternative is asked for.

  static constexpr auto fields() {
    return std::make_tuple(required("task", &allocate_task::task),
                           required("steps", &allocate_task::steps),
                           required("nodes", &allocate_task::nodes),
                           required("excluded", &allocate_task::excluded),
                           required("why", &allocate_task::why));
  }
};

/// The SCHEDULER. Errors: no_feasible_allocation, conflict (a node has left in
/// the middle of the search).
using scheduler_actor =
    introspected_actor::extend<caf::replies_to<allocate_task>::with<task_plan>>;

/// Holds the resources of an allocation from now on.
struct record_intent {
  std::string task;
  std::string request; ///< JSON of the task request, to compare bodies.
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes; ///< Node of each spec.
  std::string accepted;           ///< JSON of the reply once all steps run.

  static constexpr auto fields() {
    return std::make_tuple(required("task", &record_intent::task),
                           required("request", &record_intent::request),
                           required("specs", &record_intent::specs),
                           required("nodes", &record_intent::nodes),
                           required("accepted", &record_intent::accepted));
  }
};

struct intent_recorded {
  std::vector<instance_spec> specs;     ///< Completed with what the cell adds.
  std::vector<node_agent_actor> agents; ///< Agent of each spec's node.

  static constexpr auto fields() {
    return std::make_tuple(required("specs", &intent_recorded::specs),
                           required("agents", &intent_recorded::agents));
  }
};

/// How a deployment ended. A failed one is rolled back before the reply.
struct record_outcome {
  std::string task;
  bool running = false;
  std::string reason; ///< Why not.

  static constexpr auto fields() {
    return std::make_tuple(required("task", &record_outcome::task),
                           required("running", &record_outcome::running),
                           required("reason", &record_outcome::reason));
  }
};

struct outcome_recorded {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// Asks whether a task request may go on. Tasks take turns from here until
/// their intent is recorded, so that two never count on the same resources.
struct claim_task {
  std::string task;
  std::string request; ///< JSON of the task request.

  static constexpr auto fields() {
    return std::make_tuple(required("task", &claim_task::task),
                           required("request", &claim_task::request));
  }
};

struct task_claimed {
  /// JSON of the first reply when the same request has been done already.
  std::string accepted;

  static constexpr auto fields() {
    return std::make_tuple(required("accepted", &task_claimed::accepted));
  }
};

/// The CELL COORDINATOR: owns the cell registry and the tasks.
using cell_coordinator_actor = introspected_actor::extend<
    // A node has authenticated itself; a MEMBER is made for it.
    caf::reacts_to<session_admitted>,
    // Errors: conflict (the name belongs to another UUID, an old epoch).
    caf::replies_to<register_node>::with<node_registered>,
    caf::replies_to<depart_node>::with<node_departed>,
    caf::reacts_to<member_lost>,
    // From a member or the local supervisor.
    caf::reacts_to<instance_changed>,
    caf::replies_to<cell_query>::with<cell_description>,
    caf::replies_to<cell_list_query>::with<cell_list>,
    // Errors of the queries: unknown_task.
    caf::replies_to<task_query>::with<task_description>,
    caf::replies_to<instance_query>::with<instance_description>,
    caf::replies_to<log_query>::with<log_excerpt>,
    caf::replies_to<skill_query>::with<skill_list>,
    // Waits while the same request is being deployed. The task is the sender's
    // until it records an outcome or ends. Errors: task_exists, conflict.
    caf::replies_to<claim_task>::with<task_claimed>,
    caf::replies_to<collect_resources>::with<cell_resources>,
    // Errors: conflict (a member has gone meanwhile).
    caf::replies_to<find_agents>::with<agents_found>,
    // Errors: conflict (a member has gone meanwhile).
    caf::replies_to<record_intent>::with<intent_recorded>,
    caf::replies_to<record_outcome>::with<outcome_recorded>,
    // Errors: unknown_task.
    caf::replies_to<task_termination>::with<task_terminated>,
    caf::reacts_to<presence_seen>, caf::reacts_to<presence_gone>,
    caf::reacts_to<peer_opened>, caf::reacts_to<peer_lost>,
    caf::reacts_to<peer_told>, caf::reacts_to<peer_changed>,
    // Errors: unreachable (the coordinator that hands out places is silent).
    caf::replies_to<place_request>::with<place_granted>,
    // Errors: conflict (the name belongs to another node).
    caf::replies_to<place_reservation>::with<place_reserved>,
    // Errors: unknown_cell, conflict (this cell is not to be evened out).
    caf::replies_to<member_surrender>::with<members_surrendered>,
    // One outcome a name; no errors.
    caf::replies_to<cell_formation>::with<cell_formed>,
    // Errors: unknown_node, unknown_cell, conflict (a coordination node, the
    // node's own cell, instances, already switching), unreachable, unresolved,
    // no_feasible_allocation.
    caf::replies_to<node_transfer>::with<node_transferred>,
    caf::replies_to<node_release>::with<node_released>,
    // Errors: unknown_task.
    caf::replies_to<transfer_query>::with<transfer_description>,
    // INTERNAL: timer number N.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// A request as it came in at an edge.
struct route_request {
  std::string text; ///< Bytes from outside, not checked yet.
  std::string only; ///< The one type that is allowed; empty: any.

  static constexpr auto fields() {
    return std::make_tuple(required("text", &route_request::text),
                           required("only", &route_request::only));
  }
};

/// The answer: a reply or an error, as JSON text.
struct request_routed {
  std::string text;
  /// Code of a refusal; empty when the request was done.
  std::string refusal;

  static constexpr auto fields() {
    return std::make_tuple(required("text", &request_routed::text),
                           required("refusal", &request_routed::refusal));
  }
};

/// The REQUEST ROUTER: message type to pipeline, else handler, else rejection.
/// It always replies; what goes wrong is in the reply's text.
using request_router_actor = introspected_actor::extend<
    caf::replies_to<route_request>::with<request_routed>>;

/// A request that has passed its schema.
struct process_request {
  std::string text;

  static constexpr auto fields() {
    return std::make_tuple(required("text", &process_request::text));
  }
};

struct request_processed {
  std::string text; ///< JSON of the reply.

  static constexpr auto fields() {
    return std::make_tuple(required("text", &request_processed::text));
  }
};

/// A HANDLER PIPELINE: one request on its way through a chain of handlers. It
/// ends with its request. Errors: those of its handlers.
using handler_pipeline_actor = introspected_actor::extend<
    caf::replies_to<process_request>::with<request_processed>>;

/// Ends the node in order: leaves the cell, closes the edges, keeps instances.
struct stop_node {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// The NODE: root of everything that runs on one machine.
using node_actor = introspected_actor::extend<
    caf::replies_to<node_query>::with<node_description>,
    caf::reacts_to<stop_node>>;

} // namespace roscell
