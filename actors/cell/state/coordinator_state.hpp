#pragma once

#include "actors/cell/books/cell_registry.hpp"
#include "actors/cell/books/free_node_book.hpp"
#include "actors/cell/books/peer_book.hpp"
#include "actors/cell/books/task_table.hpp"
#include "actors/house/alarm.hpp"
#include "actors/house/house.hpp"
#include "actors/placement/search_guard.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// What a coordinator is told when it starts.
struct coordinator_setup {
  std::string cell;
  std::string discovery_server; ///< "ip:port"
  int64_t incarnation = 0;
  node_identity self; ///< Of the coordination node itself.
  std::vector<installed_skill> skills;
  node_agent_actor agent; ///< Of the coordination node itself.
  /// Runs what an earlier run of the node has left; may be invalid in tests.
  container_supervisor_actor supervisor;
  state_store_actor store;
  std::vector<task_record> tasks;      ///< As an earlier run has stored them.
  std::vector<member_record> members;  ///< The same.
  std::vector<transfer_row> transfers; ///< The same; those that were open.
  /// What instances of this cell find in their environment.
  std::map<std::string, std::string> environment;
  /// Towards other coordinators and nodes in no cell; all invalid in a cell
  /// that is alone.
  discovery_actor discovery;
  session_connector_actor connector;
  registration_client_actor registration;
  scheduler_actor scheduler; ///< Places what leaves with a node.
  int64_t server_id = 0;     ///< Of the discovery server.
  bool rebalance = true;     ///< Cells are evened out.
  /// The scheduler's; may be empty in tests.
  std::shared_ptr<search_guard> searches;
};

/// A task request that waits for its turn to be placed.
struct waiting_claim {
  claim_task request;
  caf::actor_addr owner;
  caf::typed_response_promise<task_claimed> promise;
};

/// Somebody waits until nothing is being deployed to a node. Called once.
struct awaited_deployments {
  std::string node;
  std::function<void()> done;
};

/// A place that has been given out and not been taken yet.
struct granted_place {
  std::string coordinator; ///< UUID.
  std::chrono::steady_clock::time_point until;
};

/// Somebody waits for a node to join. Called once.
struct awaited_arrival {
  std::chrono::steady_clock::time_point deadline;
  std::function<void(const failure*)> done;
};

/// A transfer or a release; see docs/protocols.md.
struct cell_transfer {
  transfer_row row;
  /// Of `switching`: then it is `unresolved` for whoever waits.
  std::chrono::steady_clock::time_point deadline;
  std::vector<std::string> terminated;
  std::vector<std::string> rescheduled;
  std::vector<std::function<void(const cell_transfer&, const failure*)>>
      waiting;
};

/// Owns the cell registry and the tasks.
struct cell_coordinator_state {
  static constexpr const char* name = "cell-coordinator";

  house context;
  coordinator_setup setup;
  cell_registry registry;
  task_table tasks;
  /// The task whose turn it is: between its claim and its intent.
  std::string turn;
  std::deque<waiting_claim> waiting;
  std::vector<awaited_deployments> deployments_awaited;

  peer_book peers;
  free_node_book free_nodes;
  std::map<std::string, granted_place> places; ///< By UUID of the node.
  std::map<std::string, cell_transfer> transfers;
  uint64_t last_transfer = 0;
  /// Who waits for a node to join, by UUID.
  std::multimap<std::string, awaited_arrival> arrivals;
  /// When cells are to be looked at for evening out; max(): not at all.
  std::chrono::steady_clock::time_point balance_due =
      std::chrono::steady_clock::time_point::max();
  size_t balancing = 0; ///< Cells that are asked to give up members.
  alarm timer;
};

using coordinator_pointer =
    cell_coordinator_actor::stateful_pointer<cell_coordinator_state>;

/// The present moment, as the registry wants it.
registry_time now_of(coordinator_pointer self);

/// Where this cell is to be found.
cell_address own_address(const coordinator_setup& setup);

} // namespace roscell
