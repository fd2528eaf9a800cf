#pragma once

#include "actors/cell/cell_coordinator.hpp"
#include "actors/membership/membership.hpp"
#include "test/fixture.hpp"
#include "test/site/site_program.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell::test {

/// One machine: a coordination node, or one that looks for a cell. Its disk
/// survives a kill.
struct site_party {
  size_t index = 0;
  bool coordinates = false;
  std::string name;
  std::string uuid;
  std::string address;
  std::string cell;             ///< Coordinators only.
  std::string discovery_server; ///< The same.
  std::string configured;       ///< Nodes only; see `membership_record`.
  std::map<std::string, std::map<std::string, std::string>> disk; ///< By table.
  bool disk_full = false;
  std::vector<store_record> waiting; ///< Not written yet; lost with a kill.
  std::map<std::string, site_program> programs; ///< By instance.
  std::chrono::milliseconds build_takes{0};
  bool builds_fail = false;
  bool retired = false; ///< It does not come back.

  unsigned life = 0;                  ///< Counts its starts.
  caf::actor edge;                    ///< Plays every part around it.
  cell_coordinator_actor coordinator; ///< Invalid unless it coordinates.
  membership_actor membership;        ///< Invalid if it does.
  container_supervisor_actor supervisor;
  container_listener_actor listener; ///< The same, for its runtime.
  node_agent_actor agent;
  scheduler_actor planner;              ///< Coordinators only.
  request_router_actor router;          ///< The same.
  std::string looking_for;              ///< A discovery server.
  std::vector<follow_server> followed;  ///< What its server was told of others.
  std::optional<serve_programs> served; ///< How its own server was asked for.
  std::optional<node_presence> announced;
  std::map<size_t, node_presence> shown; ///< What it sees of which party.

  actor_context context; ///< Tells events as this party's.

  bool alive() const {
    return edge != nullptr;
  }

  /// Whoever hears of discovery; the party lives.
  caf::actor brain() const;

  /// The state of its actor, which nothing works on meanwhile.
  cell_coordinator_state& cell_state() const;
  membership_status& status() const;

  /// The actors that end when its process is killed, but for those of sessions.
  std::vector<caf::actor> actors() const;
  void forget_actors();
};

} // namespace roscell::test
