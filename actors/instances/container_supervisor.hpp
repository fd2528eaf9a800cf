#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/edge/process/skill_grants.hpp"
#include "actors/instances/life/skill_metrics.hpp"
#include "actors/instances/skills/current_skills.hpp"
#include "messages/messages.hpp"

#include <caf/error.hpp>
#include <caf/typed_response_promise.hpp>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace roscell {

struct container_supervisor_config {
  actor_context context;
  std::string node;    ///< The node's name, for rows.
  std::string address; ///< Where it is, without a port.
  shared_skills skills;
  /// Spawns the runtime; called again when it has died.
  std::function<runtime_actor(container_listener_actor)> make_runtime;
  /// That runtime needs an image of a skill before it can start it.
  bool builds_images = true;
  state_store_actor store;
  graph_watch_actor graph;    ///< Invalid: no ROS 2 program is looked after.
  node_history_actor history; ///< Reads kept logs; invalid: there are none.
  /// What the store knew when the node started.
  std::vector<instance_row> restored;
  /// Where the node was when the programs of these were started, by instance.
  std::map<std::string, std::string> started_at;
  /// In which boot of the host they were.
  std::map<std::string, std::string> started_in;
  std::string boot; ///< The present one; empty: not known.
  /// What an earlier run may have left and no record knows: it is ended.
  std::vector<std::string> strays;
  bool may_be_lost = false; ///< By a cell: it is no coordination node.
  /// What a node with a cell of its own says of it to instances, from the first
  /// one on. A member is told it later, by `use_environment`, which may be
  /// empty.
  std::map<std::string, std::string> environment;
  bool learns_place = false; ///< It is such a member.
  environment_writer
      write_environment_update;      ///< Empty: no instance can be told.
  parameter_writer write_parameters; ///< The same.
  request_answerer answer_request;   ///< The same.
  shared_skill_grants grants;        ///< Null: nothing is granted to any skill.
  secret_keeper_actor secrets;       ///< Invalid: this node keeps none.
};

/// An instance as the supervisor sees it.
struct supervised_instance {
  instance_row row;
  /// As it was when the instance was deployed, or the node began; null: the
  /// node has not had it.
  shared_skill_folder skill;
  skill_metrics_table metrics; ///< What its skill has told.
  quiet_notice quiet;          ///< What of it the cell has been told.
  skill_instance_actor actor;  ///< Null once the instance has ended.
  std::vector<caf::typed_response_promise<instance_deployed>> deployers;
  bool removing = false;
  bool confirmed = false;    ///< The coordinator in contact wants it.
  bool forced = false;       ///< Without waiting until it is stop-safe.
  bool cleaning = false;     ///< What it left is being removed.
  bool acknowledged = false; ///< The coordinator keeps that it has ended.
  bool log_dropped = false;  ///< What it left is gone, or is going.
  int deaths = 0;            ///< Of its actor, since it ran last.
  std::string started_in;    ///< The boot of the host; empty: not known.
  int64_t began_unix_ms = 0; ///< Its deployment; 0: not known.
};

/// A removal that waits for its instances to be gone, or to wait themselves.
struct pending_removal {
  std::set<std::string> left;
  std::vector<safety_wait> waiting;
  std::vector<std::string> gone;
  caf::error error; ///< Of the first that could not be removed.
  caf::typed_response_promise<instances_removed> promise;
};

/// Owns every skill instance of the node.
struct container_supervisor_state {
  static constexpr const char* name = "container-supervisor";

  container_supervisor_config config;
  runtime_actor runtime;
  int runtime_deaths = 0;
  std::string problem; ///< Of the engine under the runtime; empty: none.
  instance_listener_actor listener;
  request_router_actor router;      ///< Of this node; invalid while it starts.
  std::set<std::string> requesting; ///< Instances that wait for the cell.
  bool out_of_contact = true;       ///< And the next word tells what is wanted.
  int64_t contact_boot_ms = 0;      ///< Of the last word that reached the cell.
  /// What this node says of the cell to instances that it starts.
  std::map<std::string, std::string> environment;
  bool knows_place = true; ///< It has been said.
  std::map<std::string, supervised_instance> instances;
  std::vector<pending_removal> removals;
};

/// The CONTAINER SUPERVISOR. Messages: messages/inside/runtime.hpp.
container_supervisor_actor::behavior_type container_supervisor(
    container_supervisor_actor::stateful_pointer<container_supervisor_state>
        self,
    const container_supervisor_config& config);

} // namespace roscell
