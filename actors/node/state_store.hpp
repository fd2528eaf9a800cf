#pragma once

#include "actors/edge/disk/sqlite_store.hpp"
#include "actors/house/house.hpp"
#include "messages/messages.hpp"

#include <memory>

namespace roscell {

/// Owns the node's database. It blocks on the disk, so it is spawned detached.
struct state_store_state {
  static constexpr const char* name = "state-store";

  std::shared_ptr<sqlite_store> database;
  uint64_t written = 0; ///< Records stored or removed.
  uint64_t refused = 0; ///< Records that could not be.
};

/// The STATE STORE. Messages: messages/storage.hpp.
state_store_actor::behavior_type
state_store(state_store_actor::stateful_pointer<state_store_state> self,
            std::shared_ptr<sqlite_store> database);

} // namespace roscell
