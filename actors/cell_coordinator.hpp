#pragma once

#include "actors/cell_registry.hpp"
#include "actors/house.hpp"
#include "actors/search_guard.hpp"
#include "actors/task_table.hpp"
#include "messages/type_ids.hpp"

#include <caf/typed_response_promise.hpp>

#include <deque>
#include <map>
#include <memory>
#include <set>
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
  std::vector<task_record> tasks; ///< As an earlier run has stored them.
  /// What instances of this cell find in their environment.
  std::map<std::string, std::string> environment;
  /// The scheduler's; may be empty in tests.
  std::shared_ptr<search_guard> searches;
};

/// A task request that waits for its turn to be placed.
struct waiting_claim {
  claim_task request;
  caf::actor_addr owner;
  caf::typed_response_promise<task_claimed> promise;
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
};

using coordinator_pointer =
    cell_coordinator_actor::stateful_pointer<cell_coordinator_state>;

/// The CELL COORDINATOR. Messages: messages/coordination.hpp; its tables and
/// what happens to a task are drawn in docs/protocols.md.
cell_coordinator_actor::behavior_type
cell_coordinator(coordinator_pointer self, const house& context,
                 const coordinator_setup& setup);

} // namespace roscell
