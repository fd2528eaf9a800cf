#pragma once

#include "actors/cell/moves/move_table.hpp"
#include "actors/cell/sets/set_table.hpp"
#include "actors/cell/streams/stream_watch.hpp"
#include "actors/cell/tables/cell_builds.hpp"
#include "actors/cell/tables/cell_registry.hpp"
#include "actors/cell/tables/deployment_table.hpp"
#include "actors/cell/tables/history_table.hpp"
#include "actors/cell/tables/image_sources.hpp"
#include "actors/cell/tables/node_failures.hpp"
#include "actors/cell/tables/ordered_ends.hpp"
#include "actors/cell/tables/peer_table.hpp"
#include "actors/cell/tables/slot_table.hpp"
#include "actors/cell/tables/task_deadlines.hpp"
#include "actors/cell/tables/task_table.hpp"
#include "actors/cell/tables/transfer_table.hpp"
#include "actors/cell/tables/unassigned_node_table.hpp"
#include "actors/cell/tasks/pending_operations.hpp"
#include "actors/cell/updates/update_table.hpp"
#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/dds/ros_graph.hpp"
#include "actors/placement/searcher.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace roscell {

struct update_run;

/// What a coordinator is told when it starts.
struct coordinator_setup {
  std::string cell;
  std::string cell_uuid;        ///< Stays with the cell, whatever its name is.
  std::string discovery_server; ///< "ip:port"
  int64_t incarnation = 0;
  node_identity self; ///< Of the coordination node itself.
  std::vector<installed_skill> skills;
  std::vector<skill_problem> refused_skills;
  node_agent_actor agent;    ///< Of the coordination node itself.
  build_keeper_actor keeper; ///< The same; may be invalid in tests.
  std::string build_key;     ///< What permits for its builds are signed with.
  /// Runs what an earlier run of the node has left; may be invalid in tests.
  container_supervisor_actor supervisor;
  state_store_actor store;
  std::vector<task_record> tasks;      ///< As an earlier run has stored them.
  std::vector<member_record> members;  ///< The same.
  std::vector<transfer_row> transfers; ///< The same.
  std::vector<history_record> history; ///< The same.
  std::vector<drain_record> drains;    ///< The same.
  std::vector<cell_build> builds;      ///< The same.
  std::vector<build_remains> remains;  ///< The same.
  std::vector<task_set_record> sets;   ///< The same.
  /// What instances of this cell find in their environment.
  std::map<std::string, std::string> environment;
  bool ros2_set_parameters = false; ///< See `let_ros2_set_parameters`.
  /// Who has signed that build, or why it counts as signed by nobody; null:
  /// this node cannot tell.
  std::function<std::variant<std::string, failure>(
      const std::string& hash, const std::string& signature)>
      check_signature;
  bool require_signed_skills = false; ///< Nothing else is placed.
  /// Towards other coordinators and nodes in no cell; all invalid in a cell
  /// that is alone.
  discovery_actor discovery;
  session_connector_actor connector;
  registration_client_actor registration;
  scheduler_actor scheduler; ///< Places what leaves with a node.
  int64_t server_id = 0;     ///< Of the discovery server.
  int64_t ros_domain_id = 0; ///< Of the cell's skills.
  bool rebalance = true;     ///< Cells are balanced in size.
  /// What the cell's discovery server knows of ROS 2 topics. May be null in
  /// tests.
  std::shared_ptr<ros_graph> graph;
  /// The scheduler's; may be empty in tests.
  std::shared_ptr<search_guard> searches;
};

/// Owns the cell registry and the tasks.
struct cell_coordinator_state {
  static constexpr const char* name = "cell-coordinator";

  actor_context context;
  coordinator_setup setup;
  cell_registry registry;
  task_table tasks;
  task_deadlines deadlines;
  deployment_table deployments;
  cell_builds builds;
  std::set<std::string> additions; ///< Hashes of builds on their way into it.
  image_readers images;
  stream_watch streams;
  pending_operations pending;
  history_table history;
  std::vector<store_record> events; ///< Of that, not written yet.
  /// When they are written; max(): there are none.
  std::chrono::steady_clock::time_point events_due =
      std::chrono::steady_clock::time_point::max();
  node_failures failures;
  ordered_ends orders;
  move_table moves;
  update_table updates;
  set_table sets;
  /// What the messages of each update carry along, by its id in the table.
  std::map<uint64_t, std::shared_ptr<update_run>> update_runs;
  drain_table drains;
  rebalance_table rebalance;

  peer_table peers;
  unassigned_node_table unassigned_nodes;
  slot_table slots;
  transfer_table transfers;
  /// When cells are to be balanced, if their sizes differ; max(): not at all.
  std::chrono::steady_clock::time_point balance_due =
      std::chrono::steady_clock::time_point::max();
  size_t balancing = 0;        ///< Cells that are asked to hand over members.
  request_router_actor router; ///< Of this node; invalid while it starts.
  alarm timer;
};

using coordinator_pointer =
    cell_coordinator_actor::stateful_pointer<cell_coordinator_state>;

/// The present moment, as the registry wants it.
registry_time now_of(coordinator_pointer self);

/// Adds to a spec what the cell adds to every instance.
void complete_spec(const cell_coordinator_state& st, instance_spec& spec);

/// Whether a node is to be empty, so that nothing is placed there.
bool is_draining(const cell_coordinator_state& st, const registry_entry& node);

/// Where this cell is to be found.
cell_address own_address(const coordinator_setup& setup);

} // namespace roscell
