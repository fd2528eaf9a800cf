#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/core/backoff.hpp"
#include "actors/edge/dds/discovery_server.hpp"
#include "actors/edge/dds/public_presence.hpp"
#include "actors/edge/dds/server_inquiry.hpp"
#include "messages/messages.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

struct discovery_config {
  std::string address; ///< Local IPv4 address.
  std::string node;    ///< Name, for events.
  uint32_t public_domain_id = 99;
  std::vector<std::string> peers;  ///< "HOST[:PORT]" besides multicast.
  uint16_t discovery_port = 11811; ///< Of the node's own discovery server.
  /// What that server knows; null: nobody wants to know.
  std::shared_ptr<ros_graph> graph;
  /// Of that server; null: it begins at 1.
  std::shared_ptr<number_reserve> numbers;
  /// A coordinator's: the cell's server, which lives longer than this actor.
  cell_server* cell = nullptr;
};

/// Owns the participants of a node, its own discovery server and the public
/// one, and its inquiry for a coordinator's. Making and deleting them takes
/// some milliseconds, so it is spawned as one that blocks.
struct discovery_state {
  static constexpr const char* name = "discovery";

  actor_context context;
  discovery_config config;
  std::string looking_for;
  std::unique_ptr<server_inquiry> inquiry;
  std::unique_ptr<cell_server> server;
  discovery_place served;         ///< By `server`.
  std::map<uint8_t, int64_t> met; ///< Other servers, by what meeting.
  int64_t meetings = 0;           ///< Counts them.
  std::string announced;          ///< In wire form; empty: nothing.
  std::unique_ptr<public_presence> presence;
  presence_listener_actor listener; ///< Of `presence`.
  std::vector<std::string> peers;   ///< Of `presence`, in numbers.
  std::string unresolved;           ///< What was told of peers' names last.
  backoff pause;                    ///< Until they are looked up again.
  alarm timer;
};

/// The DISCOVERY edge. Messages: messages/inside/link.hpp. Whoever asks for a
/// coordinator is told `coordinator_found`, again with each new announcement;
/// whoever announces itself is told of the others. Events: edge_trouble,
/// coordinator_ignored.
discovery_actor::behavior_type
discovery(discovery_actor::stateful_pointer<discovery_state> self,
          const actor_context& context, const discovery_config& config);

// What the discovery actor does with discovery servers: its node's own one,
// and what that knows of others.

using discovery_self = discovery_actor::stateful_pointer<discovery_state>;

/// Errors: see `discovery_actor`.
caf::result<programs_served>
serve_programs_of_node(discovery_self self, const serve_programs& request);

/// Does nothing where no server runs.
void follow_another_server(discovery_self self, const follow_server& request);

} // namespace roscell
