#pragma once

#include "actors/edge/discovery_client.hpp"
#include "actors/house.hpp"
#include "messages/type_ids.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace roscell {

struct discovery_config {
  std::string address; ///< Local IPv4 address.
  uint32_t domain_id = 0;
  std::string node; ///< Name, for the announcement.
  std::string uuid;
};

/// Owns the CLIENT participant of a primary node. Making and deleting it takes
/// some milliseconds, so this actor is spawned detached.
struct discovery_state {
  static constexpr const char* name = "discovery";

  house context;
  discovery_config config;
  std::string looking_for;
  std::unique_ptr<cell_client> client;
};

/// The DISCOVERY edge. Messages: messages/link.hpp. Whoever asks for a
/// coordinator is told `coordinator_found`, again with each new announcement.
discovery_actor::behavior_type
discovery(discovery_actor::stateful_pointer<discovery_state> self,
          const house& context, const discovery_config& config);

} // namespace roscell
